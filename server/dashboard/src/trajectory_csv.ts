/** A trajectory as the service gives it: columns, the phase in words. */
export type Trajectory = Record<string, readonly (number | string | null)[]>;

/** One line a point, a header of the columns' names; every digit that the document has. */
export function trajectoryCsv(trajectory: Trajectory): string {
  const names = Object.keys(trajectory).filter((name) => Array.isArray(trajectory[name]));
  const size = Math.max(0, ...names.map((name) => trajectory[name]?.length ?? 0));
  const lines = [names.join(",")];
  for (let k = 0; k < size; ++k) lines.push(names.map((name) => trajectory[name]?.[k] ?? "").join(","));
  return `${lines.join("\n")}\n`;
}
