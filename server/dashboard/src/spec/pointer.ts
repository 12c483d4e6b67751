// JSON pointers [RFC 6901]: places in a spec.

export type Path = readonly string[];

export const toPointer = (path: Path): string => path.map((part) => `/${part.replace(/~/g, "~0").replace(/\//g, "~1")}`).join("");

export const parsePointer = (pointer: string): string[] =>
  pointer === "" ? [] : pointer.split("/").slice(1).map((part) => part.replace(/~1/g, "/").replace(/~0/g, "~"));

/** Whether `pointer` is at `path` or within. */
export const isWithin = (pointer: string, path: Path): boolean => {
  const place = toPointer(path);
  return pointer === place || pointer.startsWith(`${place}/`);
};

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

export const isObject = (value: Json | undefined): value is { [key: string]: Json } =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/** undefined where there is nothing. */
export function getAt(root: Json | undefined, path: Path): Json | undefined {
  let value = root;
  for (const part of path) {
    if (Array.isArray(value)) value = value[Number(part)];
    else if (isObject(value) && Object.hasOwn(value, part)) value = value[part];
    else return undefined;
  }
  return value;
}

/** A copy with another value at a path; undefined takes it away, with the objects that are empty then. */
export function setAt(root: Json, path: Path, value: Json | undefined): Json {
  const [first, ...rest] = path;
  if (first === undefined) return value ?? {};
  const from = isObject(root) ? root : {};
  const copy = { ...from };
  const inner = rest.length > 0 ? setAt(copy[first] ?? {}, rest, value) : value;
  if (inner === undefined || (value === undefined && isObject(inner) && Object.keys(inner).length === 0)) delete copy[first];
  else copy[first] = inner;
  return copy;
}

/** The spec as text: what is short on one line. */
export function formatSpec(value: Json, indent = ""): string {
  const short = inline(value);
  if (indent.length + short.length <= 88 && (indent !== "" || short.length < 40)) return short;
  const deeper = `${indent}  `;
  if (Array.isArray(value)) return `[\n${value.map((item) => deeper + formatSpec(item, deeper)).join(",\n")}\n${indent}]`;
  if (isObject(value)) {
    const rows = Object.entries(value).map(([key, item]) => `${deeper}${JSON.stringify(key)}: ${formatSpec(item, deeper)}`);
    return `{\n${rows.join(",\n")}\n${indent}}`;
  }
  return short;
}

function inline(value: Json): string {
  if (Array.isArray(value)) return `[${value.map(inline).join(", ")}]`;
  if (isObject(value)) return `{${Object.entries(value).map(([key, item]) => `${JSON.stringify(key)}: ${inline(item)}`).join(", ")}}`;
  return JSON.stringify(value);
}
