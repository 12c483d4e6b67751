import { useMemo, useState } from "preact/hooks";
import { type ComparisonView, type Status, type StudyState, statuses } from "../documents";
import { statusWords, symbol, unitText } from "../names";
import { count, none, number, percent, percentOf, percentRange } from "../numbers";
import { useDocument, usePage } from "../page_context";
import { BreakingCode, Card, Empty, Figure, Select, Shown, StatusMark, StatusName } from "../parts";
import { TwoDistributions, DistributionPlot } from "../plots/distribution";
import type { Points } from "../plots/marks";
import { Plane, axisOver } from "../plots/plane";
import { go, studyLink, trialLink } from "../route";
import type { StudyPage } from "../source";

export function CompareView({ a, b }: { a: string | null; b: string | null }) {
  const { source } = usePage();
  const list = useDocument<StudyPage>("studies", (signal) => source.studies(null, signal));
  const studies = list.value?.studies ?? [];
  const isChosen = a !== null && b !== null && a !== b;
  return (
    <div class="page compare">
      <div class="page-head">
        <div>
          <h1>Compare two studies</h1>
          <p class="lead">Trial by trial on the same draws: what did the change change?</p>
        </div>
      </div>
      <div class="compare-choice">
        <StudyChoice label="A" side="a" value={a} studies={studies} onChange={(id) => go({ view: "compare", a: id, b })} />
        <button type="button" class="button quiet" disabled={a === null && b === null} aria-label="Exchange A and B" onClick={() => go({ view: "compare", a: b, b: a })}>⇄</button>
        <StudyChoice label="B" side="b" value={b} studies={studies} onChange={(id) => go({ view: "compare", a, b: id })} />
      </div>
      {isChosen ? <Chosen key={`${a} ${b}`} a={a} b={b} /> : (
        <Empty title={a !== null && a === b ? "A study is like itself" : "Choose two studies"}>
          <p>They should draw alike: the same seed and distributions, and another controller, say.</p>
        </Empty>
      )}
    </div>
  );
}

function StudyChoice({ label, side, value, studies, onChange }: { label: string; side: "a" | "b"; value: string | null; studies: readonly StudyState[]; onChange: (id: string | null) => void }) {
  const isListed = studies.some((study) => study.id === value);
  return (
    <label class={`compare-side side-${side}`}>
      <span class="side-letter">{label}</span>
      <select value={value ?? ""} onChange={(event) => onChange(event.currentTarget.value || null)}>
        <option value="">choose…</option>
        {value !== null && !isListed && <option value={value}>{value}</option>}
        {studies.map((study) => <option key={study.id} value={study.id}>{study.name} · {study.id.slice(0, 8)} · {count(study.progress.completed)} trials</option>)}
      </select>
    </label>
  );
}

/** A value of a canonical spec; of what only the other spec has, nothing. */
function SpecValue({ value }: { value: unknown }) {
  return value === null || value === undefined ? <span class="muted" title="Has no meaning in this study">–</span> : <code>{JSON.stringify(value)}</code>;
}

const pValue = (p: number) => (p < 1e-300 ? "below 10⁻³⁰⁰" : number(p, 3));

function Chosen({ a, b }: { a: string; b: string }) {
  const { source } = usePage();
  const loaded = useDocument<ComparisonView>(`${a} ${b}`, (signal) => source.comparison(a, b, signal));
  return <Shown loaded={loaded} height={700}>{(view) => <Comparison view={view} />}</Shown>;
}

function Comparison({ view }: { view: ComparisonView }) {
  const { comparison, settling_time } = view;
  const names: [string, string] = [`A ${comparison.a.name}`, `B ${comparison.b.name}`];
  const { success_rate: rate, pairs, mcnemar, settling_time_difference: difference } = comparison;
  return (
    <div class="grid compare-grid">
      {comparison.warnings.length > 0 && (
        <div class="problem mild wide"><strong>Know first</strong><ul>{comparison.warnings.map((warning) => <li key={warning}>{warning}</li>)}</ul></div>
      )}
      <Card title="Success rate" note={`Of ${count(pairs.total)} pairs of trials with the same draws.`}>
        <p class="big">{points(rate.difference.estimate, rate.difference.ci_low, rate.difference.ci_high)}<span class="big-note"> percentage points, B less A</span></p>
        <p class="interval">{rate.difference.ci_low === null ? "no interval over several cells together" : `${signedRange(rate.difference.ci_low, rate.difference.ci_high).replace(" %", "")} · ${number(100 * rate.difference.level)} % interval (Tango)`}</p>
        <dl class="figures">
          <Figure name="A"><a href={studyLink(comparison.a.id)}>{percentOf(rate.a, rate.difference.ci_low, rate.difference.ci_high)}</a></Figure>
          <Figure name="B"><a href={studyLink(comparison.b.id)}>{percentOf(rate.b, rate.difference.ci_low, rate.difference.ci_high)}</a></Figure>
          <Figure name="McNemar's exact p">{mcnemar ? pValue(mcnemar.p_value) : none}</Figure>
          {mcnemar && mcnemar.holm_p_value !== null && <Figure name="Holm">{pValue(mcnemar.holm_p_value)}</Figure>}
        </dl>
      </Card>
      <Card title="Pairs">
        <PairTable view={view} />
      </Card>
      <Card class="wide" title="What differs in their specs">
        {comparison.differences.length === 0 ? <p class="muted">Nothing that decides an outcome.</p> : (
          <div class="scroll"><table class="table differences">
            <thead><tr><th scope="col">Place</th><th scope="col">A</th><th scope="col">B</th></tr></thead>
            <tbody>{comparison.differences.map((each) => <tr key={each.pointer}><th scope="row"><BreakingCode text={each.pointer} at="/" /></th><td><SpecValue value={each.a} /></td><td><SpecValue value={each.b} /></td></tr>)}</tbody>
          </table></div>
        )}
      </Card>
      <Card title="Settling times" actions={<p class="legend"><span class="line-sample" /> A <span class="line-sample dashed" /> B</p>} note={`Of the pairs: ${count(settling_time.a.trials)} converged in A, ${count(settling_time.b.trials)} in B. Shaded: bands that hold the whole curve.`}>
        {settling_time.a.x.length + settling_time.b.x.length > 0 ? <TwoDistributions a={settling_time.a} b={settling_time.b} names={names} /> : <p class="muted">No trial converged.</p>}
      </Card>
      <Card title="Difference of settling times" note={difference ? `B less A, of ${count(difference.pairs)} pairs in which both converged. Mean ${number(difference.mean.estimate)} s (${number(difference.mean.ci_low)} to ${number(difference.mean.ci_high)}), median ${number(difference.median.estimate)} s (${number(difference.median.ci_low)} to ${number(difference.median.ci_high)}).` : "No pair converged on both sides."}>
        {settling_time.difference.x.length > 0 && <DistributionPlot distribution={{ ...settling_time.difference, metric: "settling time, B less A" }} height={260} />}
      </Card>
      <Discordant view={view} />
      {comparison.cells.length > 0 && <Cells view={view} />}
    </div>
  );
}

/** To the digit that the interval allows. */
const signedPercent = (share: number | null, low: number | null, high: number | null) => (share === null ? none : `${share > 0 ? "+" : ""}${percentOf(share, low, high)}`);
const points = (share: number | null, low: number | null, high: number | null) => signedPercent(share, low, high).replace(" %", "");
const signedRange = (low: number | null, high: number | null) => percentRange(low, high).replace(/-/g, "−");

function PairTable({ view }: { view: ComparisonView }) {
  const { pairs } = view.comparison;
  const cell = (n: number, tone: string, what: string) => (
    <td class={`pair ${tone}`}><strong>{count(n)}</strong><span>{pairs.total > 0 ? percent(n / pairs.total) : none}</span><span class="muted small">{what}</span></td>
  );
  return (
    <table class="pairs">
      <thead><tr><td /><th scope="col">B converged</th><th scope="col">B did not</th></tr></thead>
      <tbody>
        <tr><th scope="row">A converged</th>{cell(pairs.both, "both", "both")}{cell(pairs.a_only, "a-only", "A alone")}</tr>
        <tr><th scope="row">A did not</th>{cell(pairs.b_only, "b-only", "B alone")}{cell(pairs.neither, "neither", "neither")}</tr>
      </tbody>
    </table>
  );
}

/** Trials that converged on one side alone, over two inputs and as a list. */
function Discordant({ view }: { view: ComparisonView }) {
  const { discordant, inputs, comparison } = view;
  const names = inputs.map((each) => each.input);
  const [x, setX] = useState(names[0] ?? "");
  const [y, setY] = useState(names[1] ?? names[0] ?? "");
  const statusOf = (code: number | undefined): Status => statuses[code ?? 1] ?? "timeout";
  const points = useMemo<Points>(() => {
    const column = (input: string) => discordant.inputs[names.indexOf(input)] ?? [];
    // As B sees it: blue where B converged and A did not.
    return { index: discordant.index, status: discordant.status_b.map(statusOf), x: column(x), y: column(y) };
  }, [view, x, y]);
  if (discordant.index.length === 0) {
    return <Card class="wide" title="Discordant trials"><p class="muted">Every pair ended alike: there is no trial that converged on one side alone.</p></Card>;
  }
  const along = (input: string, values: readonly number[]) => axisOver(input, inputs.find((each) => each.input === input)?.unit ?? "1", values);
  const options = names.map((input) => ({ value: input, text: `${symbol(input)} · ${input}` }));
  const failuresOfB = statuses.filter((status) => status !== "converged" && points.status.includes(status));
  const all = comparison.discordant.a_only.count + comparison.discordant.b_only.count;
  return (
    <Card class="wide" title="Discordant trials" note={`${count(discordant.index.length)} of ${count(all)} that converged on one side alone. Click one to see it in the study where it failed.`}>
      <div class={names.length >= 2 ? "two" : ""}>
        {names.length >= 2 && (
          <div>
            <div class="controls">
              <Select label="Across" value={x} options={options} onChange={(next) => { if (next === y) setY(x); setX(next); }} />
              <Select label="Up" value={y} options={options} onChange={(next) => { if (next === x) setX(y); setY(next); }} />
            </div>
            <Plane x={along(x, points.x)} y={along(y, points.y)} points={points} height={340} onPick={(k) => go({ view: "trial", id: points.status[k] === "converged" ? comparison.a.id : comparison.b.id, index: points.index[k] ?? 0, t: null })} />
            <p class="legend"><span><StatusMark status="converged" /> converged in B alone</span>{failuresOfB.map((status) => <span key={status}><StatusMark status={status} /> in A alone, {statusWords[status]} in B</span>)}</p>
          </div>
        )}
        <div class="scroll tall" tabIndex={0} role="group" aria-label="Discordant trials">
          <table class="table numbers">
            <thead><tr><th scope="col" class="right">Trial</th><th scope="col">A</th><th scope="col">B</th><th scope="col" class="right">settled [s]</th>{inputs.map((each) => <th key={each.input} scope="col" class="right" title={each.input}>{symbol(each.input)}{each.unit !== "1" && ` [${unitText(each.unit)}]`}</th>)}</tr></thead>
            <tbody>
              {discordant.index.slice(0, 200).map((index, k) => (
                <tr key={index}>
                  <th scope="row" class="right">{index}</th>
                  <td><a href={trialLink(comparison.a.id, index)} aria-label={`Trial ${index} in A: ${statusWords[statusOf(discordant.status_a[k])]}`}><StatusName status={statusOf(discordant.status_a[k])} /></a></td>
                  <td><a href={trialLink(comparison.b.id, index)} aria-label={`Trial ${index} in B: ${statusWords[statusOf(discordant.status_b[k])]}`}><StatusName status={statusOf(discordant.status_b[k])} /></a></td>
                  <td class="right">{number(discordant.settling_time[k] ?? null)}</td>
                  {inputs.map((each, at) => <td key={each.input} class="right">{number(discordant.inputs[at]?.[k] ?? null)}</td>)}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </div>
    </Card>
  );
}

function Cells({ view }: { view: ComparisonView }) {
  const { cells } = view.comparison;
  return (
    <Card class="wide" title="Cell by cell" note={cells.length > 200 ? `The first 200 of ${count(cells.length)}.` : ""}>
      <div class="scroll tall" tabIndex={0} role="group" aria-label="Cells">
        <table class="table numbers">
          <thead><tr><th scope="col">Cell</th><th scope="col" class="right">A</th><th scope="col" class="right">B</th><th scope="col" class="right">B less A</th><th scope="col" class="right">interval</th><th scope="col" class="right">p (Holm)</th></tr></thead>
          <tbody>
            {cells.slice(0, 200).map((cell, k) => (
              <tr key={k}>
                <th scope="row">{Object.entries(cell.sweep).map(([input, value]) => `${symbol(input)} = ${number(value)}`).join(", ")}</th>
                <td class="right">{percent(cell.success_rate.a)}</td>
                <td class="right">{percent(cell.success_rate.b)}</td>
                <td class="right strong">{signedPercent(cell.success_rate.difference.estimate, cell.success_rate.difference.ci_low, cell.success_rate.difference.ci_high)}</td>
                <td class="right">{signedRange(cell.success_rate.difference.ci_low, cell.success_rate.difference.ci_high)}</td>
                <td class="right">{number(cell.mcnemar?.holm_p_value ?? cell.mcnemar?.p_value ?? null, 3)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Card>
  );
}
