// The documents that the page draws, by the names it uses for them. The types come from the schemas.
import type * as documents from "./generated/documents";

export type StudyView = documents.Study;
export type MapView = documents.Map;
export type TrialView = documents.Trial;
export type ComparisonView = documents.Comparison;
export type ReportView = documents.Report;

export type Summary = StudyView["summary"];
export type Sample = Summary["settling_time"];
/** A goal of a stopping rule; the generated type loses its keys to the `oneOf` beside them. */
export interface PrecisionGoal {
  metric: string;
  quantile: number | null;
  reached: boolean;
  estimate: number | null;
  ci_low: number | null;
  ci_high: number | null;
}
export type Gate = Summary["gates"][number];
export type Distribution = StudyView["distributions"][number];
export type Marginal = StudyView["marginals"][number];
export type Axis = MapView["x"];
export type Status = documents.Status;
export type PhaseKind = TrialView["phases"]["kind"][number];

/** In the order of the numbers that stand for them. */
export const statuses: readonly Status[] = ["converged", "timeout", "singular", "diverged", "integrator_failed"];

/** How a study fares, from the service. */
export interface StudyState {
  id: string;
  name: string;
  status: "queued" | "running" | "succeeded" | "failed" | "cancelled";
  progress: { completed: number; requested: number; trials_per_s: number | null; eta_s: number | null };
  created: string;
  started: string | null;
  finished: string | null;
  /** Why it failed; absent or null otherwise. */
  failure?: string | null;
}

export const isActive = (state: StudyState) => state.status === "queued" || state.status === "running";
