import { useState } from "preact/hooks";
import type { StudyView } from "../documents";
import { metricName, symbol } from "../names";
import { count, number, none } from "../numbers";
import { Card, Select } from "../parts";

type Sensitivity = NonNullable<StudyView["sensitivity"]>;

interface Bar {
  input: string;
  rows: { name: string; value: number | null; low: number | null; high: number | null }[];
}

/** Sobol' indices as bars with their intervals: of the data at hand, or of a pick-freeze design where there is one. */
export function SensitivityBars({ sensitivity, used }: {
  sensitivity: Sensitivity;
  /** Trials that count. */
  used: number;
}) {
  const { given_data: given, sobol_indices: sobol } = sensitivity;
  const [metric, setMetric] = useState("success");
  const outputs = sobol ? (["success", "settling_time", "end_time"] as const).map((name) => ({ metric: name as string, bars: sobolBars(sobol[name]), trials: sobol.rows[name] })) : given.outputs.map((output) => ({ metric: output.metric, bars: givenBars(output.inputs), trials: output.trials }));
  const output = outputs.find((each) => each.metric === metric) ?? outputs[0];
  if (!output) return null;
  const bars = [...output.bars].sort((a, b) => strength(b) - strength(a));
  const empty = bars.every((bar) => bar.rows.every((row) => row.value === null));
  const level = sobol ? sobol.level : given.level;
  return (
    <Card
      title="What drives it"
      actions={<Select label="Of" value={output.metric} options={outputs.map((each) => ({ value: each.metric, text: metricName(each.metric) }))} onChange={setMetric} />}
      note={`Sobol' indices: the share of the variance that an input explains ${sobol ? "alone (first order), and with others in total" : "alone (first order)"}. ${sobol ? `From ${count(output.trials)} rows` : `From ${sensitivity.of < used ? `the first ${count(sensitivity.of)} of ${count(used)}` : count(output.trials)} trials`}; lines are ${number(100 * level)} % bootstrap intervals.${!sobol && given.exact ? " A full factorial: without sampling error." : ""}`}
    >
      {empty ? <p class="muted">There is nothing to explain: too few trials, or all ended alike.</p> : (
        <table class="bars">
          <colgroup><col class="bars-name" /><col /><col class="bars-number" /></colgroup>
          <thead class="unseen"><tr><th scope="col">Input</th><th scope="col">Index</th><th scope="col">Value</th></tr></thead>
          <tbody>
            {bars.map((bar) => bar.rows.map((row, k) => (
              <tr key={`${bar.input} ${row.name}`} class={k > 0 ? "second" : ""}>
                <th scope="row"><span class={k === 0 ? "" : "unseen"} title={bar.input}>{symbol(bar.input)}</span>{bar.rows.length > 1 && <span class="muted small bar-kind"> {row.name}</span>}</th>
                <td><IndexBar value={row.value} low={row.low} high={row.high} /></td>
                <td class="right" title={row.low === null || row.high === null ? undefined : `${number(100 * level)} % interval ${fixed(row.low)} to ${fixed(row.high)}`}>{row.value === null ? none : fixed(row.value)}</td>
              </tr>
            )))}
          </tbody>
          <tfoot aria-hidden="true"><tr><td /><td><span class="bar-scale"><span>0</span><span>0.5</span><span>1</span></span></td><td /></tr></tfoot>
        </table>
      )}
    </Card>
  );
}

/** With three digits behind the point; nothing is less than nothing. */
const fixed = (value: number) => value.toFixed(3).replace(/^-(0\.0*)$/, "$1").replace("-", "−");

const strength = (bar: Bar) => Math.max(...bar.rows.map((row) => row.value ?? -1));

function givenBars(inputs: Sensitivity["given_data"]["outputs"][number]["inputs"]): Bar[] {
  return inputs.map((each) => ({ input: each.input, rows: [{ name: "first order", value: each.first_order, low: each.ci_low, high: each.ci_high }] }));
}

function sobolBars(indices: NonNullable<Sensitivity["sobol_indices"]>["success"]): Bar[] {
  return indices.map((each) => ({
    input: each.input,
    rows: [
      { name: "alone", value: each.first_order, low: each.ci_low, high: each.ci_high },
      { name: "total", value: each.total, low: each.total_ci_low, high: each.total_ci_high },
    ],
  }));
}

function IndexBar({ value, low, high }: { value: number | null; low: number | null; high: number | null }) {
  const at = (share: number) => 100 * Math.min(1, Math.max(0, share));
  return (
    <svg class="bar" viewBox="0 0 100 16" preserveAspectRatio="none" aria-hidden="true">
      <rect x="0" y="0" width="100" height="16" class="bar-room" />
      {value !== null && <rect x="0" y="3" width={at(value)} height="10" class="bar-value" />}
      {low !== null && high !== null && <line x1={at(low)} x2={at(high)} y1="8" y2="8" class="bar-interval" />}
    </svg>
  );
}

/** Inputs by how much they explain of success, most first. */
export function byStrength(sensitivity: Sensitivity, inputs: readonly string[]): string[] {
  const rows = sensitivity.sobol_indices?.success ?? sensitivity.given_data.outputs.find((output) => output.metric === "success")?.inputs ?? [];
  const strengthOf = (input: string) => rows.find((row) => row.input === input)?.first_order ?? -Infinity;
  return [...inputs].sort((a, b) => strengthOf(b) - strengthOf(a));
}
