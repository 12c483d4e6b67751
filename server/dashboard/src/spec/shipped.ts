// The specs that come with the program, as starting points.
const files = import.meta.glob<string>(
  ["../../../../studies/specs/{paper,robustness,parameter,nightly}/*.json", "../../../../studies/specs/nightly.json"],
  { query: "?raw", import: "default", eager: true },
);

export interface Shipped {
  name: string;
  group: string;
  text: string;
}

const groups = ["robustness", "paper", "parameter", "nightly"];

export const shipped: readonly Shipped[] = Object.entries(files)
  .map(([path, text]) => {
    const [folder = "", file = ""] = path.split("/").slice(-2);
    return { name: file.replace(".json", ""), group: folder === "specs" ? "nightly" : folder, text: text.trimEnd() };
  })
  .filter(({ text }) => !/"kind"\s*:\s*"approximation"/.test(text)) // has no trials, so no view here
  .sort((a, b) => groups.indexOf(a.group) - groups.indexOf(b.group) || a.name.localeCompare(b.name));
