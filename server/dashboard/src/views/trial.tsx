import { useEffect, useMemo, useState } from "preact/hooks";
import type { StudyState, TrialView } from "../documents";
import { failedTrials } from "../failed_trials";
import { meaning, statusMeaning, symbol, unitText } from "../names";
import { counted, number, quantity } from "../numbers";
import { toProblem, useDocument, usePage } from "../page_context";
import { BreakingCode, Card, Empty, Figure, Shown, StatusName } from "../parts";
import { Player } from "../player";
import { ContractionPlot } from "../plots/contraction";
import { PhasePlane } from "../plots/phase_plane";
import { Robot } from "../plots/robot";
import { type Column, TimeSeries } from "../plots/time_series";
import { PhaseLegend, Timeline } from "../plots/timeline";
import { studyLink, trialLink } from "../route";
import { trajectoryCsv } from "../trajectory_csv";
import { ServiceSource } from "../source";

export function TrialPage({ id, index, start }: { id: string; index: number; start: number | null }) {
  const { source } = usePage();
  const loaded = useDocument<TrialView>(`${id}/${index}`, (signal) => source.trial(id, index, signal));
  useEffect(() => {
    document.title = `Trial ${index} · steerstat`;
    return () => {
      document.title = "steerstat";
    };
  }, [index]);
  return (
    <div class="page trial">
      <div class="page-head">
        <div>
          <p class="crumbs">
            {!source.report && <><a href="#/">Studies</a> <span aria-hidden="true">/</span> </>}
            <a href={studyLink(id)}>{loaded.value?.study.name ?? source.report?.study.summary.study.name ?? id}</a> <span aria-hidden="true">/</span>{" "}
            <a href={studyLink(id, "trials")}>trials</a>
          </p>
          <h1>Trial {index}</h1>
          <p class="facts">{loaded.value ? <Outcome view={loaded.value} /> : !loaded.problem && <span class="muted">…</span>}</p>
        </div>
        <Neighbours id={id} index={index} />
      </div>
      <Shown loaded={loaded} height={900}>{(view) => <Trial key={view.index} view={view} start={start} />}</Shown>
    </div>
  );
}

function Outcome({ view }: { view: TrialView }) {
  const { outcome } = view;
  return (
    <>
      <span class={`outcome status-${outcome.status}`} title={statusMeaning[outcome.status]}><StatusName status={outcome.status} /></span>
      <span>after {quantity(outcome.end_time, "s", 5)}</span>
      <span>{counted(outcome.cycles, "contraction cycle")}</span>
      <span>{counted(outcome.swings, "swing")}</span>
      <span>{counted(outcome.alignments, "alignment")}</span>
    </>
  );
}

/** The trials before and after, and those that failed where they are known. */
function Neighbours({ id, index }: { id: string; index: number }) {
  const { source } = usePage();
  const failed = failedTrials(id);
  const state = useDocument<StudyState>(id, (signal) => source.state(id, signal));
  const end = state.value?.progress.requested ?? Infinity;
  const listed = source.report?.trials.map((each) => each.index).sort((a, b) => a - b); // a report has some trials alone
  const before = [...failed].reverse().find((each) => each < index && source.has(each));
  const after = failed.find((each) => each > index && source.has(each));
  const link = (to: number | undefined, text: string) =>
    to !== undefined && to >= 0 && to < end && source.has(to) ? <a class="button quiet" href={trialLink(id, to)}>{text}</a> : <button type="button" class="button quiet" disabled>{text}</button>;
  return (
    <div class="page-actions">
      {link(listed ? listed.filter((each) => each < index).pop() : index - 1, "← Previous")}
      {link(listed ? listed.find((each) => each > index) : index + 1, "Next →")}
      {failed.length > 0 && link(before, "← Failed")}
      {failed.length > 0 && link(after, "Failed →")}
    </div>
  );
}

/** What is dashed in a figure. */
const referenceWords: Partial<Record<Column, string>> = { q1: "goal", q1_dot: "rest" };

const figures: readonly { title: string; columns: readonly [Column, Column] }[] = [
  { title: "Joint positions", columns: ["q1", "q2"] },
  { title: "Joint velocities", columns: ["q1_dot", "q2_dot"] },
  { title: "Acceleration and force", columns: ["a", "tau"] },
];

function Trial({ view, start }: { view: TrialView; start: number | null }) {
  const end = view.trajectory.t[view.trajectory.t.length - 1] ?? view.outcome.end_time;
  const player = useMemo(() => new Player(end, start ?? 0), [view]);
  if (view.trajectory.t.length === 0) return <Empty title="This trial has no course"><p>It ended before anything moved.</p></Empty>;
  const { trajectory } = view;
  const thinned = trajectory.t.length < trajectory.of;
  return (
    <div class="grid trial-grid">
      <Card class="stage" title="From above" actions={<span class="muted small">outline: the goal · arrow: the force τ</span>}>
        <Robot view={view} player={player} />
        <Timeline view={view} player={player} />
      </Card>
      <Card title="Outcome">
        <OutcomeFigures view={view} />
        <Varying view={view} />
        <Links view={view} />
      </Card>
      {figures.map(({ title, columns }) => (
        <Card key={title} class="figure-card" title={title} actions={<PhaseLegend view={view} reference={referenceWords[columns[0]]} />}>
          <TimeSeries view={view} column={columns[0]} player={player} height={158} isNamed isLast={false} />
          <TimeSeries view={view} column={columns[1]} player={player} height={196} isNamed={false} isLast />
        </Card>
      ))}
      <Card class="figure-card" title="Phase plane of the passive joint" actions={<PhaseLegend view={view} />}
        note={`${view.policy === "paper" ? "Shaded: the contraction set." : "Shaded: where the policy brakes; dashed in it: its aim."} Circle: the goal.${dashed(view)}`}>
        <PhasePlane view={view} player={player} height={324} />
      </Card>
      <Card class="wide" title="Error per contraction cycle" note={contractionNote(view)} actions={<p class="legend"><span class="line-sample" /> happened <span class="line-sample dashed" /> predicted</p>}>
        {view.contraction.start.length > 0 ? (
          <div class="two">
            <ContractionPlot contraction={view.contraction} of="distance" height={260} />
            <ContractionPlot contraction={view.contraction} of="speed" height={260} />
          </div>
        ) : <p class="muted">No contraction cycle ran its whole period in this trial.</p>}
      </Card>
      <Parameters view={view} />
      <p class="note wide">
        {thinned ? `${trajectory.t.length.toLocaleString("en")} of ${trajectory.of.toLocaleString("en")} points are drawn; none left out lies farther than ${number(100 * trajectory.largest_deviation, 2)} % of its axis from the line. ` : ""}
        {view.phases.of > view.phases.kind.length ? `The first ${view.phases.kind.length} of ${view.phases.of} phases are shaded. ` : ""}
        {isTouched() ? "Two fingers zoom into a chart over time, one moves along it, a double tap shows all again; tap to go to a time." : "Drag over a chart to zoom, double-click to see all again, click to go to a time."}
      </p>
    </div>
  );
}

/** Which phases of the course are no whole lines. */
function dashed(view: TrialView): string {
  const words = ([["drift", "drift dotted"], ["swing", "swings dashed"]] as const).filter(([kind]) => view.phases.kind.includes(kind)).map(([, text]) => text);
  return words.length > 0 ? ` The course: ${words.join(", ")}.` : "";
}

const isTouched = () => matchMedia("(pointer: coarse)").matches;

function contractionNote(view: TrialView): string {
  const { eta1, eta2, rate, start } = view.contraction;
  if (start.length === 0) return "";
  const predicted = rate === null
    ? `Predicted (14), (15): a cycle leaves η₁ = ${number(eta1)} of the distance to go and η₂ = ${number(eta2)} of the speed.`
    : `Predicted: what the robust policy aims at with a cycle that brakes, and the alignment where one follows: a speed of ${number(rate)} 1/s times the distance to go.`;
  return `${predicted} Hollow: beyond the goal, or away from it. Short bars: ε, whose tolerance ends the trial.`;
}

function OutcomeFigures({ view }: { view: TrialView }) {
  const { outcome, references } = view;
  return (
    <dl class="figures">
      <Figure name="passive error ε">{number(outcome.passive_error)}</Figure>
      <Figure name="active error">{number(outcome.active_error)}</Figure>
      <Figure name="effort">{quantity(outcome.effort, "N² s")}</Figure>
      <Figure name="peak |a|">{quantity(outcome.peak_acceleration, "m/s²")}</Figure>
      <Figure name="peak |τ|">{quantity(outcome.peak_force, "N")}</Figure>
      <Figure name="peak |q₁ − goal|">{quantity(outcome.peak_stroke, "m")}</Figure>
      <Figure name="goal q₁">{quantity(references.q1, "m")}</Figure>
      <Figure name="goal q₂">{quantity(references.q2, "rad")}</Figure>
      <Figure name="horizon">{quantity(view.horizon, "s")}</Figure>
      {view.policy === "paper" ? <Figure name="realignment">{view.realignment.replace("_", " ")}</Figure> : <Figure name="policy">{view.policy}</Figure>}
    </dl>
  );
}

function Links({ view }: { view: TrialView }) {
  const { source } = usePage();
  const [failure, setFailure] = useState("");
  const { id } = view.study;
  const path = `v1/studies/${encodeURIComponent(id)}/trials/${view.index}/trajectory`;
  const csv = async () => {
    try {
      if (source instanceof ServiceSource) save(trajectoryCsv(await source.trajectory(id, view.index)), `trial-${view.index}.csv`);
      setFailure("");
    } catch (error) {
      setFailure(toProblem(error).message);
    }
  };
  return (
    <div class="links">
      {source instanceof ServiceSource && (
        <p class="link-row">
          <button type="button" class="button" onClick={csv}>CSV of the trajectory</button>
          <a class="button quiet" href={path}>as JSON</a>
        </p>
      )}
      <p class="muted small">The same bits, from the result file:</p>
      <pre class="command" tabIndex={0} aria-label="Command">steerstat replay {source.report?.file ?? "RESULT.h5"} --trial {view.index} -o trial-{view.index}.csv</pre>
      {failure && <p class="failure" role="alert">{failure}</p>}
    </div>
  );
}

function save(text: string, name: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  URL.revokeObjectURL(url);
}

function ParameterList({ parameters }: { parameters: TrialView["parameters"] }) {
  return (
    <ul class="parameters">
      {parameters.map((each) => (
        <li key={each.input} title={meaning(each.input)}>
          <span>{symbol(each.input)}<BreakingCode class="id" text={each.input} at="." /></span>
          <strong>{each.value === null ? "no limit" : number(each.value, 6)}{each.unit !== "1" && <span class="muted"> {unitText(each.unit)}</span>}</strong>
        </li>
      ))}
    </ul>
  );
}

function Varying({ view }: { view: TrialView }) {
  const varying = view.parameters.filter((each) => each.varies);
  if (varying.length === 0) return null;
  return (
    <div class="varying">
      <h3>What varies in this study, here</h3>
      <ParameterList parameters={varying} />
    </div>
  );
}

function Parameters({ view }: { view: TrialView }) {
  const fixed = view.parameters.filter((each) => !each.varies);
  return (
    <Card class="wide" title="Parameters">
      <details>
        <summary>The same in every trial of the study ({fixed.length})</summary>
        <ParameterList parameters={fixed} />
      </details>
    </Card>
  );
}

