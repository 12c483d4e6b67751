// Listed trials as a table of text: names in the first line, a trial in each one after it.

export type ListedTrial = Record<string, number>;

/** "plant.m1, plant.f2" and a line a trial; a value that a trial lacks is left empty. */
export function listedText(trials: readonly ListedTrial[]): string {
  const names = [...new Set(trials.flatMap((trial) => Object.keys(trial)))];
  return [names, ...trials.map((trial) => names.map((name) => (name in trial ? String(trial[name]) : "")))].map((line) => line.join(", ")).join("\n");
}

/** @return undefined of nothing; what is wrong, with its line, of what is no table */
export function readListed(text: string): ListedTrial[] | string | undefined {
  const lines = text.split("\n").map((line) => line.trim());
  while (lines[lines.length - 1] === "") lines.pop();
  if (lines.length === 0) return undefined;
  const names = (lines[0] ?? "").split(",").map((name) => name.trim());
  if (names.some((name) => name === "" || name === "__proto__")) return "line 1: the names of inputs, with commas between";
  const trials: ListedTrial[] = [];
  for (const [k, line] of lines.slice(1).entries()) {
    const cells = line.split(",").map((cell) => cell.trim());
    if (cells.length !== names.length) return `line ${k + 2}: ${cells.length} values, and there are ${names.length} names`;
    const trial: ListedTrial = {};
    for (const [at, cell] of cells.entries()) {
      if (cell === "") continue;
      const value = Number(cell);
      if (!Number.isFinite(value)) return `line ${k + 2}: ${cell} is no number`;
      trial[names[at] ?? ""] = value;
    }
    trials.push(trial);
  }
  return trials;
}
