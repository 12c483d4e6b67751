import { useState } from "preact/hooks";
import type { Gate, PrecisionGoal, Sample, StudyView, Summary } from "../documents";
import { methodWords, metricName, metricUnit, symbol } from "../names";
import { count, number, percent, percentOf, percentRange, quantity } from "../numbers";
import { usePage } from "../page_context";
import { Card, Choice, Figure, Select } from "../parts";
import { Cycles } from "../plots/cycles";
import { DistributionPlot } from "../plots/distribution";
import { HeatMap } from "../plots/heat_map";
import { Narrowing } from "../plots/narrowing";
import { Outcomes } from "../plots/outcomes";
import { studyLink, trialLink } from "../route";
import { FailureRate, RareDiagnostics } from "./rare_failures";

export function Overview({ view }: { view: StudyView }) {
  const { summary } = view;
  const rate = summary.success_rate;
  return (
    <div class="grid overview">
      {summary.rare_failures ? <FailureRate rare={summary.rare_failures} outcomes={summary.outcomes} /> : (
        <Card class="headline" title="Success rate" note={usedNote(view)}>
          <p class="big">{percentOf(rate.estimate, rate.ci_low, rate.ci_high)}</p>
          <p class="interval">{percentRange(rate.ci_low, rate.ci_high)}<span class="muted"> · {number(100 * rate.level)} % interval ({methodWords[rate.method]})</span></p>
          <Outcomes outcomes={summary.outcomes} />
        </Card>
      )}
      {summary.rare_failures ? <RareDiagnostics rare={summary.rare_failures} /> : summary.sketch ? <Kept sketch={summary.sketch} id={summary.study.id} /> : view.narrowing.of > 1 ? <Card title="How it narrowed" note={`Of the first ${count(view.narrowing.of)} trials. ${view.narrowing.at_once ? "The intervals hold at all numbers of trials together." : "Each interval holds by itself, not all together."}`}>
        <Narrowing view={view} />
      </Card> : <SingleTrial view={view} />}
      {summary.gates.length > 0 && <Gates gates={summary.gates} />}
      {view.sweeps && <div class="wide"><HeatMap sweeps={view.sweeps} /></div>}
      {view.rows === "all" && view.trials.used > 1 && <Distributions view={view} />}
      {view.rows === "all" && view.trials.used > 1 && (
        <Card title="Contraction cycles" note="Of all trials." actions={<p class="legend"><span><span class="swatch fill-converged" /> converged</span><span><span class="swatch fill-timeout" /> others</span></p>}>
          <Cycles cycles={view.cycles} />
        </Card>
      )}
      <Metrics summary={summary} />
      {summary.stop && <Stop stop={summary.stop} />}
      <Audit audit={summary.audit} id={summary.study.id} />
      <SpecCard spec={view.spec} isAlone={Boolean(summary.stop)} />
    </div>
  );
}

/** Which rows a study keeps that does not keep all, and what is missing without the others. */
function Kept({ sketch, id }: { sketch: NonNullable<Summary["sketch"]>; id: string }) {
  return (
    <Card title="What is kept" note="How the rate narrowed, distributions, cycles, maps and indices need the row of every trial: run the study with “store”: “all” for them.">
      <p>{sketch.store === "failed" ? "The rows of the trials that failed, and of some that were audited or retained." : "No rows, but of some trials that were audited or retained."}</p>
      <p>All trials are in the rates and metrics: counts, extremes, means and spreads are exact, quantiles within {percent(sketch.relative_error, 2)}.</p>
      {sketch.store === "failed" && <p class="see-trial"><a class="button" href={studyLink(id, "why")}>Where they failed</a></p>}
    </Card>
  );
}

/** Where there is one trial, or one so far: nothing narrows and nothing is distributed. */
function SingleTrial({ view }: { view: StudyView }) {
  const [index] = view.sample.index;
  const { source } = usePage();
  return (
    <Card title={view.trials.requested > 1 ? "The first trial" : "The trial"}>
      <p class="muted">{view.trials.requested > 1 ? "How the rate narrows shows from the second trial on." : "This study has one trial: its course tells more than its rate."}</p>
      {index !== undefined && source.has(index) && <p class="see-trial"><a class="button primary" href={trialLink(view.summary.study.id, index)}>See trial {index}</a></p>}
    </Card>
  );
}

function usedNote(view: StudyView): string {
  const { used, finished } = view.trials;
  return used === finished ? "" : `Of ${count(finished)} finished trials ${count(used)} are independent, and counted here.`;
}

function Distributions({ view }: { view: StudyView }) {
  const [metric, setMetric] = useState("");
  const distribution = view.distributions.find((each) => each.metric === metric) ?? view.distributions[0];
  if (!distribution) return null;
  const { band, trials } = distribution;
  const whose = metricName(distribution.metric);
  return (
    <Card
      title="Distribution"
      actions={<Select label="Metric" isHidden value={distribution.metric} options={view.distributions.map((each) => ({ value: each.metric, text: metricName(each.metric) }))} onChange={setMetric} />}
      note={`${whose[0]?.toUpperCase()}${whose.slice(1)} of the ${count(trials)} trials that have one. ${band && band.half_width < 1 ? `The whole curve lies within ± ${percent(band.half_width)} at level ${number(100 * band.level)}\u00a0%.` : distribution.band_note ? `No band: ${distribution.band_note}.` : ""}`}
    >
      <DistributionPlot distribution={distribution} height={248} />
    </Card>
  );
}

const tableMetrics = ["settling_time", "cycles", "effort", "peak_acceleration", "peak_force", "peak_stroke", "position_contraction_mean", "position_contraction_worst", "velocity_contraction_mean", "velocity_contraction_worst"] as const;
const columns: readonly [keyof Sample, string][] = [["min", "min"], ["p05", "5 %"], ["p50", "median"], ["p95", "95 %"], ["p99", "99 %"], ["max", "max"], ["mean", "mean"], ["std", "std"]];

function Metrics({ summary }: { summary: Summary }) {
  const rows = tableMetrics.filter((metric) => summary[metric].count > 0);
  if (rows.length === 0) return null;
  return (
    <Card class="wide" title="Metrics" note="Settling time and cycles are of converged trials, effort and peaks of all, contraction ratios of those with a finished cycle.">
      <div class="scroll" tabIndex={0} role="group" aria-label="Metrics">
        <table class="table numbers">
          <thead>
            <tr><th scope="col">Metric</th><th scope="col" class="right">trials</th>{columns.map(([key, text]) => <th key={key} scope="col" class="right">{text}</th>)}</tr>
          </thead>
          <tbody>
            {rows.map((metric) => (
              <tr key={metric}>
                <th scope="row">{metricName(metric)}{metricUnit(metric) !== "1" && <span class="muted"> [{metricUnit(metric)}]</span>}</th>
                <td class="right">{count(summary[metric].count)}</td>
                {columns.map(([key]) => <td key={key} class={`right ${key === "p50" ? "strong" : ""}`}>{number(summary[metric][key], 4)}</td>)}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Card>
  );
}

const verdictMarks = { pass: "✓", fail: "✕", inconclusive: "?" } as const;

function Gates({ gates }: { gates: readonly Gate[] }) {
  const [which, setWhich] = useState<"all" | "open">("all");
  const shown = which === "all" ? gates : gates.filter((gate) => gate.verdict !== "pass");
  const failed = gates.filter((gate) => gate.verdict === "fail").length;
  const unclear = gates.filter((gate) => gate.verdict === "inconclusive").length;
  return (
    <Card
      class="wide"
      title={`Gates: ${failed > 0 ? `${failed} failed` : unclear > 0 ? `${unclear} inconclusive` : "all passed"}`}
      actions={gates.length > 6 && <Choice label="Which" value={which} onChange={setWhich} options={[{ value: "all", text: "All" }, { value: "open", text: "Not passed" }]} />}
    >
      <ul class="gates">
        {shown.slice(0, 100).map((gate, k) => (
          <li key={k} class={`gate ${gate.verdict}`}>
            <span class="verdict"><span aria-hidden="true">{verdictMarks[gate.verdict]}</span> {gate.verdict}</span>
            <span class="gate-what"><strong>{metricName(gate.metric)}</strong> <code>{gate.expr}</code>
              {gate.cell && <span class="muted"> at {Object.entries(gate.cell).map(([input, value]) => `${symbol(input)} = ${number(value)}`).join(", ")}</span>}
            </span>
            <span class="gate-why">{gate.reason}</span>
          </li>
        ))}
      </ul>
      {shown.length > 100 && <p class="note">{count(shown.length - 100)} more are in the summary.</p>}
    </Card>
  );
}

function Stop({ stop }: { stop: NonNullable<Summary["stop"]> }) {
  const reasons = { precision_reached: "every goal was reached", max_trials: "the most trials were taken first" };
  return (
    <Card title="When it stopped" note={`${count(stop.looks)} looks; each interval holds at all of them together (level ${number(100 * stop.level)} %).`}>
      <p>{stop.reason ? `After ${count(stop.trials)} trials: ${reasons[stop.reason]}.` : `Not by its rule, of ${count(stop.trials)} trials so far.`}</p>
      <ul class="plain-list">
        {(stop.until as unknown as PrecisionGoal[]).map((goal, k) => (
          <li key={k}>
            <strong>{goal.reached ? "✓" : "✕"}</strong> {metricName(goal.metric.replace(/_rate$/, "")) + (goal.metric.endsWith("_rate") ? " rate" : "")}
            {goal.quantile !== null && `, ${number(100 * goal.quantile)} % quantile`}: {goalText(goal)}
          </li>
        ))}
      </ul>
    </Card>
  );
}

/** An estimate in its interval, with its unit. */
function goalText({ metric, estimate, ci_low: low, ci_high: high }: PrecisionGoal): string {
  if (metric.endsWith("_rate")) return `${percentOf(estimate, low, high)} in ${percentRange(low, high)}`;
  const unit = metricUnit(metric);
  return `${quantity(estimate, unit)} in ${number(low)} to ${quantity(high, unit)}`;
}

function Audit({ audit, id }: { audit: Summary["audit"]; id: string }) {
  if (!audit) {
    return <Card title="Audit"><p class="muted">None of these trials were computed again by SUNDIALS yet.</p></Card>;
  }
  const { settling_time_difference: difference } = audit;
  return (
    <Card title="Audit" note={`Computed again by SUNDIALS at tolerance ${number(audit.tolerance)}: the same status, cycles and swings${difference ? ", and settling times so close" : ""}.`}>
      <p class="big small">{count(audit.agree)} of {count(audit.trials)} agree</p>
      {difference && (
        <dl class="figures">
          <Figure name="median difference">{quantity(difference.median, "s", 2)}</Figure>
          <Figure name="99 % within">{quantity(difference.p99, "s", 2)}</Figure>
          <Figure name="at most">{quantity(difference.max, "s", 2)}</Figure>
        </dl>
      )}
      {audit.disagree.length > 0 && <p>Not so: {audit.disagree.slice(0, 20).map((index) => <a key={index} class="listed" href={trialLink(id, index)}>trial {index}</a>)}</p>}
    </Card>
  );
}

/** @param isAlone  whether no card stands beside it */
function SpecCard({ spec, isAlone }: { spec: string; isAlone: boolean }) {
  let text = spec;
  try {
    text = JSON.stringify(JSON.parse(spec), null, 2);
  } catch {
    // shown as it is
  }
  return (
    <Card class={isAlone ? "wide" : ""} title="Spec" note="With every default filled in.">
      <pre class="spec" tabIndex={0} aria-label="Spec">{text}</pre>
    </Card>
  );
}

