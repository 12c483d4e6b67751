// The form's fields, from the schema of specs: what it does not show, the JSON beside it can say.
import schema from "../../../../schemas/study.schema.json";
import type { Json, Path } from "./pointer";

interface Schema {
  $ref?: string;
  type?: string;
  description?: string;
  default?: Json;
  properties?: Record<string, Schema>;
  allOf?: Schema[];
  enum?: Json[];
  minimum?: number;
  maximum?: number;
}

export type Kind = "value" | "number" | "integer" | "choice" | "flag" | "text";

export interface Field {
  path: Path;
  kind: Kind;
  /** Without its unit. */
  description: string;
  unit: string;
  default: Json | undefined;
  choices: string[];
  /** Whether draws may multiply the nominal value. */
  canBeRelative: boolean;
}

export interface Section {
  key: string;
  title: string;
  description: string;
  fields: Field[];
  isOpen: boolean;
}

const root = schema as unknown as Schema & { $defs: Record<string, Schema> };
const refersTo = (of: Schema, name: string) => of.$ref === `#/$defs/${name}` || (of.allOf ?? []).some((each) => each.$ref === `#/$defs/${name}`);

function resolve(of: Schema): Schema {
  const name = of.$ref?.replace("#/$defs/", "");
  const base = name === undefined ? undefined : root.$defs[name];
  return base ? { ...base, ...of } : of;
}

function fieldsUnder(of: Schema, path: Path): Field[] {
  return Object.entries(of.properties ?? {}).flatMap(([key, each]) => fieldsAt(each, [...path, key]));
}

function fieldsAt(of: Schema, path: Path): Field[] {
  const isValue = refersTo(of, "value") || refersTo(of, "plant_value");
  const whole = isValue ? of : resolve(of);
  if (whole.properties) return fieldsUnder(whole, path);
  const [, unit = "", description = ""] = /^(?:\[([^\]]*)\] ?)?(.*)$/s.exec(of.description ?? whole.description ?? "") ?? [];
  const kind: Kind | null = isValue ? "value"
    : whole.enum ? "choice"
    : whole.type === "boolean" ? "flag"
    : whole.type === "integer" ? "integer"
    : whole.type === "number" ? "number"
    : whole.type === "string" ? "text"
    : null;
  if (kind === null) return []; // lists have editors of their own, or are in the JSON
  return [{ path, kind, description, unit: unit || "1", default: whole.default, choices: (whole.enum ?? []).map(String), canBeRelative: refersTo(of, "plant_value") }];
}

const titles: readonly [key: string, title: string, isOpen: boolean][] = [
  ["plant", "Plant", true],
  ["initial_state", "Initial state", true],
  ["controller", "Controller", false],
  ["goal", "Goal", false],
  ["nominal", "Nominal plant", false],
  ["actuator", "Actuator", false],
  ["sensor", "Sensor", false],
  ["integrator", "Integrator", false],
  ["retain", "Retained trajectories", false],
  ["audit", "Audit", false],
  ["stop", "When to stop", false],
  ["intervals", "Intervals", false],
  ["baseline", "Baseline", false],
];

/** Sections of the form with their fields, in the order in which one thinks of them. */
export const sections: readonly Section[] = titles.map(([key, title, isOpen]) => {
  const of = root.properties?.[key] ?? {};
  return { key, title, description: of.description ?? "", fields: fieldsAt(of, [key]), isOpen };
});

const single = (key: string): Field => {
  const field = fieldsAt(root.properties?.[key] ?? {}, [key])[0];
  if (!field) throw new Error(`the schema has no ${key}`);
  return field;
};

export const nameField = single("name");
export const horizonField = single("horizon");

export const samplingMethods = [
  { value: "monte_carlo", text: "Monte Carlo: independent draws" },
  { value: "latin_hypercube", text: "Latin hypercube" },
  { value: "sobol", text: "Sobol' sequence" },
  { value: "sobol_indices", text: "Sobol' indices (pick-freeze)" },
  { value: "grid", text: "grid of the sweeps" },
  { value: "explicit", text: "listed trials" },
] as const;

export const rateNames: readonly string[] = (root.$defs.rate_name?.enum ?? []).map(String);
export const metricNames: readonly string[] = (root.$defs.metric_name?.enum ?? []).map(String);

/** Rates that a stopping rule can wait for, and metrics. */
export const goalMetrics: readonly string[] = (root.$defs.precision_goal?.properties?.metric?.enum ?? []).map(String);

/** Every place that a field of the form stands for. */
export const allFields: readonly Field[] = [nameField, horizonField, ...sections.flatMap((section) => section.fields)];
