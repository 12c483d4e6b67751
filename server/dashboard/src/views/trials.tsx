import { useMemo, useState } from "preact/hooks";
import { type Status, type StudyView, statuses } from "../documents";
import { statusWords, symbol, unitText } from "../names";
import { count, number } from "../numbers";
import { usePage } from "../page_context";
import { Card, Empty, Select, StatusName } from "../parts";
import { go, replaceRoute, trialLink } from "../route";

interface Row {
  index: number;
  status: Status;
  time: number | null;
  inputs: number[];
}

/** Trials one by one: the sample at hand and all that failed first. */
export function TrialsTab({ view, query }: { view: StudyView; query: Readonly<Record<string, string>> }) {
  const { source } = usePage();
  const id = view.summary.study.id;
  const [most, setMost] = useState(100);
  const rows = useMemo(() => collect(view), [view]);
  const wanted = query.status ?? "all";
  const shown = rows.filter((row) => wanted === "all" || (wanted === "failed" ? row.status !== "converged" : row.status === wanted))
    .filter((row) => !source.report || source.has(row.index));
  const present = statuses.filter((status) => view.summary.outcomes[status] > 0);
  const failures = statuses.reduce((sum, status) => sum + (status === "converged" ? 0 : view.summary.outcomes[status]), 0);
  const numbered = (text: string, n: number) => (source.report || view.rows === "failed" || view.rows === "none" ? text : `${text} (${count(n)})`);
  return (
    <Card title="Trials" note={note(view, source.report !== null)} actions={<OpenTrial id={id} count={view.trials.requested} />}>
      <div class="controls">
        <Select label="Show" value={wanted} onChange={(status) => replaceRoute({ view: "study", id, tab: "trials", query: { status } })}
          options={[
            { value: "all", text: numbered("all", view.trials.used) },
            { value: "failed", text: numbered("failed", failures) },
            ...present.map((status) => ({ value: status, text: numbered(statusWords[status], view.summary.outcomes[status]) })),
          ]} />
      </div>
      {shown.length === 0 ? <Empty title="No such trial here" /> : (
        <div class="scroll" tabIndex={0} role="group" aria-label="Trials">
          <table class="table numbers trial-table">
            <thead>
              <tr>
                <th scope="col" class="right">Trial</th>
                <th scope="col">Outcome</th>
                <th scope="col" class="right">settled [s]</th>
                {view.inputs.map((each) => (
                  <th key={each.input} scope="col" class="right" title={each.input}>{symbol(each.input)}{each.unit !== "1" && <span class="muted"> [{unitText(each.unit)}]</span>}</th>
                ))}
              </tr>
            </thead>
            <tbody>
              {shown.slice(0, most).map((row) => (
                <tr key={row.index}>
                  <th scope="row" class="right">{source.has(row.index) ? <a href={trialLink(id, row.index)}>{row.index}</a> : row.index}</th>
                  <td><StatusName status={row.status} /></td>
                  <td class="right">{number(row.time, 5)}</td>
                  {row.inputs.map((value, k) => <td key={k} class="right">{number(value, 4)}</td>)}
                  {row.inputs.length === 0 && view.inputs.map((each) => <td key={each.input} class="right muted">…</td>)}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
      {shown.length > most && <p class="more"><button type="button" class="button" onClick={() => setMost(most + 200)}>More ({count(shown.length - most)})</button></p>}
    </Card>
  );
}

function note(view: StudyView, isReport: boolean): string {
  const { sample } = view;
  const isKept = view.rows === "failed" || view.rows === "none";
  if (isKept) return `The study keeps the rows of ${view.rows === "failed" ? "trials that failed, and of some that were" : "some trials that were"} audited or retained.${isReport ? " The report holds the courses of those listed." : ""} Any other is replayed by its number.`;
  if (isReport) return "A report holds the courses of some trials: those listed. The result file has all.";
  return sample.index.length >= sample.of ? "" : `${count(sample.index.length)} of ${count(sample.of)} trials chosen at random, and the first that failed. Any other opens by its number.`;
}

/** The sample, and the failed trials that it has not, by index. */
function collect(view: StudyView): Row[] {
  const { sample, failed } = view;
  const rows = sample.index.map((index, k): Row => ({
    index,
    status: statuses[sample.status[k] ?? 0] ?? "converged",
    time: sample.settling_time[k] ?? null,
    inputs: sample.inputs.map((column) => column[k] ?? NaN),
  }));
  const known = new Set(sample.index);
  failed.index.forEach((index, k) => {
    if (!known.has(index)) rows.push({ index, status: statuses[failed.status[k] ?? 1] ?? "timeout", time: null, inputs: [] });
  });
  return rows.sort((a, b) => a.index - b.index);
}

function OpenTrial({ id, count: of }: { id: string; count: number }) {
  const { source } = usePage();
  const [text, setText] = useState("");
  if (source.report) return null;
  return (
    <form class="open-trial" onSubmit={(event) => {
      event.preventDefault();
      if (/^\d+$/.test(text)) go({ view: "trial", id, index: Number(text), t: null });
    }}>
      <label>Open trial <input type="number" min="0" max={of - 1} step="1" required value={text} onInput={(event) => setText(event.currentTarget.value)} /></label>
      <button type="submit" class="button">Open</button>
    </form>
  );
}
