// What the paper calls things, and what the schema says of them.
import schema from "../../../schemas/study.schema.json";
import type { PhaseKind, Status } from "./documents";
import { powerOfTen } from "./numbers";

const symbols: Record<string, string> = {
  m1: "m₁", m2: "m₂", d2: "d₂", I2: "I₂", f1: "f₁", f2: "f₂",
  q1: "q₁", q2: "q₂", q1_dot: "q̇₁", q2_dot: "q̇₂",
  kp: "kp", kd: "kd", eta1: "η₁", eta2: "η₂", tau: "τ",
  coulomb1: "Coulomb 1", coulomb2: "Coulomb 2", coulomb_speed1: "Coulomb speed 1", coulomb_speed2: "Coulomb speed 2",
  gravity_x: "gx", gravity_y: "gy", gain: "gain", max_force: "max |τ|",
};

/** What a plot calls an input: "f₂", "q₂(0)", "η₁", else its last names in words. */
export function symbol(input: string): string {
  const parts = input.split(".");
  const last = parts[parts.length - 1] ?? input;
  const short = symbols[last];
  const words = (names: string[]) => names.join(" ").replace(/_/g, " ");
  if (parts[0] === "initial_state") return `${short ?? last}(0)`;
  if (parts[0] === "sensor") return `${short ?? last} ${parts[1] ?? ""}`;
  return short ?? words(parts.slice(parts[0] === "controller" ? 1 : -1));
}

/** "f₂ [N m s/rad]". */
export const axisLabel = (name: string, unit: string) => (unit === "1" ? name : `${name} [${unit}]`);
export const inputLabel = (input: string, unit: string) => axisLabel(symbol(input), unit);

interface Described {
  description?: string;
  properties?: Record<string, Described>;
}

/** What the schema says in plain text, as it is printed: the paper's symbols, powers raised. */
export function prose(text: string): string {
  return text
    .replace(/\bq([12])(_dot)?\b/g, (_whole, joint: string, dot?: string) => symbols[`q${joint}${dot ?? ""}`] ?? "")
    .replace(/\bpi\b/g, "π")
    .replace(/>=/g, "≥")
    .replace(/<=/g, "≤")
    .replace(/\b1e(-?\d+)\b/g, (_whole, power: string) => powerOfTen(Number(power)))
    .replace(/\b(\d+)e(-?\d+)\b/g, (_whole, digits: string, power: string) => `${digits}×${powerOfTen(Number(power))}`)
    .replace(/`([^`]*)`/g, "“$1”");
}

/** What the schema says of an input, without its unit; empty where it says nothing. */
export function meaning(input: string): string {
  let place: Described | undefined = schema as Described;
  for (const part of input.split(".")) place = place?.properties?.[part];
  return prose((place?.description ?? "").replace(/^\[[^\]]*\] */, ""));
}

export const statusWords: Record<Status, string> = {
  converged: "converged",
  timeout: "timed out",
  singular: "singular",
  diverged: "diverged",
  integrator_failed: "integrator failed",
};

export const statusMeaning: Record<Status, string> = {
  converged: "Both joints within their tolerances of the goal.",
  timeout: "The horizon came first.",
  singular: "Link 2 at rest stretched or folded, where no force moves it.",
  diverged: "A runaway or non-finite state.",
  integrator_failed: "The step size fell below 1e-12 s.",
};

/** Of intervals. */
export const methodWords = { wilson: "Wilson", clopper_pearson: "Clopper and Pearson", confidence_sequence: "confidence sequence", lognormal: "lognormal", fay_feuer: "Fay and Feuer" };

/** For bands too narrow for the whole word. */
export const phaseShort: Record<PhaseKind, readonly [string, string]> = {
  align: ["align", "A"],
  drift: ["drift", "D"],
  contraction: ["contr.", "C"],
  swing: ["swing", "S"],
};

export const phaseWords: Record<PhaseKind, string> = {
  align: "alignment",
  drift: "drift",
  contraction: "contraction",
  swing: "swing",
};

const metrics: Record<string, [name: string, unit: string]> = {
  settling_time: ["settling time", "s"],
  cycles: ["contraction cycles", "1"],
  effort: ["effort", "N² s"],
  peak_acceleration: ["peak |a|", "m/s²"],
  peak_force: ["peak |τ|", "N"],
  peak_stroke: ["peak |q₁ − goal|", "m"],
  position_contraction_mean: ["position contraction, mean", "1"],
  position_contraction_worst: ["position contraction, worst", "1"],
  velocity_contraction_mean: ["velocity contraction, mean", "1"],
  velocity_contraction_worst: ["velocity contraction, worst", "1"],
  success: ["success", "1"],
  success_rate: ["success rate", "1"],
  end_time: ["end time", "s"],
};

export const metricName = (metric: string) => metrics[metric]?.[0] ?? metric.replace(/_/g, " ");
export const metricUnit = (metric: string) => metrics[metric]?.[1] ?? "1";

/** The unit as it is printed: powers raised. */
export const unitText = (unit: string) => unit.replace(/\^2/g, "²").replace(/\^3/g, "³");
