import { useMemo, useState } from "preact/hooks";
import { type Axis, type MapView, type StudyView, statuses } from "../documents";
import { meaning, symbol } from "../names";
import { count } from "../numbers";
import { useDocument, usePage } from "../page_context";
import { Card, Choice, Empty, Loading, ProblemBox, Select, StatusName } from "../parts";
import { MarginalPlot } from "../plots/marginal";
import type { Points } from "../plots/marks";
import { Plane, axisOver, describeBin } from "../plots/plane";
import { RateLegend } from "../plots/rate_legend";
import { SensitivityBars, byStrength } from "../plots/sensitivity";
import { go, replaceRoute, trialLink } from "../route";
import { binOf, binPlane, coarser } from "../statistics";

/** Views 3: which inputs a failure comes from. */
export function WhyTab({ view, query }: { view: StudyView; query: Readonly<Record<string, string>> }) {
  const names = view.inputs.map((each) => each.input);
  const ranked = useMemo(() => (view.sensitivity ? byStrength(view.sensitivity, names) : names), [view]);
  if (names.length === 0) {
    return (
      <Empty title="Nothing varies in this study">
        <p>Each number of its spec is fixed, so there is one trial, or the same one many times.</p>
        <p><a class="button" href={trialLink(view.summary.study.id, view.sample.index[0] ?? 0)}>See the trial</a></p>
      </Empty>
    );
  }
  if (view.rows === "none") {
    return (
      <Empty title="This study keeps no rows">
        <p>Where its trials fail would show with “store”: “failed”, and how often along each input with “all”. Any trial of it is replayed by its number.</p>
      </Empty>
    );
  }
  const known = (input: string | undefined) => (input !== undefined && names.includes(input) ? input : null);
  const x = known(query.x) ?? ranked[0] ?? names[0] ?? "";
  const y = known(query.y) ?? ranked.find((input) => input !== x) ?? x;
  const choose = (nextX: string, nextY: string) =>
    replaceRoute({ view: "study", id: view.summary.study.id, tab: "why", query: { ...query, x: nextX, y: nextY } });
  if (view.rows !== "all" || view.sensitivity === null) return <Where view={view} x={x} y={y} names={names} onChoose={choose} />;
  return (
    <div class="grid why">
      {x !== y && <MapCard view={view} x={x} y={y} names={names} onChoose={choose} shownAs={query.as} />}
      <SensitivityBars sensitivity={view.sensitivity} used={view.trials.used} />
      <Card class="wide" title="Success along each input" note={`Each bin's own ${Math.round(100 * (view.marginals[0]?.level ?? 0.95))} % interval, over all values of the other inputs.`}>
        <div class="small-multiples">
          {ranked.map((input) => {
            const marginal = view.marginals.find((each) => each.axis.input === input);
            return marginal && (
              <figure key={input} title={meaning(input)}>
                <MarginalPlot marginal={marginal} />
              </figure>
            );
          })}
        </div>
      </Card>
    </div>
  );
}

/** Of trials that are not as the study's distributions draw them: where they lie, and no rates. */
function Where({ view, x, y, names, onChoose }: { view: StudyView; x: string; y: string; names: readonly string[]; onChoose: (x: string, y: string) => void }) {
  const { source } = usePage();
  const all = usePoints(view, x, y);
  const isSought = view.rows === "sought";
  const points = useMemo(() => (isSought ? all : chosenPoints(all, (status) => status !== "converged")), [all, isSought]);
  const unit = (input: string) => view.inputs.find((each) => each.input === input)?.unit ?? "1";
  const options = inputOptions(names);
  const present = statuses.filter((status) => points.status.includes(status));
  const of = isSought ? view.sample.of : view.failed.of;
  return (
    <Card class="map-card" title={isSought ? "Trials over two inputs" : "Failures over two inputs"}>
      {x !== y && (
        <div class="controls">
          <Select label="Across" value={x} options={options} onChange={(next) => onChoose(next, next === y ? x : y)} />
          <Select label="Up" value={y} options={options} onChange={(next) => onChoose(next === x ? y : x, next)} />
          <button type="button" class="button quiet" onClick={() => onChoose(y, x)}>Exchange</button>
        </div>
      )}
      {points.index.length === 0 ? <Empty title={isSought ? "No trial yet" : "No trial failed"} /> : x === y ? <p class="muted">One input varies: a plane needs two. The trials are listed under “Trials”.</p> : (
        <>
          <Plane x={axisOver(x, unit(x), points.x)} y={axisOver(y, unit(y), points.y)} points={points} onPick={(place) => go({ view: "trial", id: view.summary.study.id, index: points.index[place] ?? 0, t: null })}
            canOpen={source.report ? (index) => source.has(index) : undefined} height={430} />
          <p class="legend">{present.map((status) => <StatusName key={status} status={status} />)}</p>
        </>
      )}
      <p class="note">
        {points.index.length < of ? `${count(points.index.length)} of ${count(of)} ${isSought ? "trials" : "failures"}, chosen at random. ` : ""}
        {isSought
          ? "The trials were drawn where failures are sought: this shows where they lie, and how dense they are says nothing of how often. Success along each input and indices would be untrue, and are left out."
          : "The study keeps the rows of failures alone: this shows where they lie, not how often trials there fail."}
        {source.report ? " Those in rings are in this report." : ""} Click one to see what happened in it.
      </p>
    </Card>
  );
}

const inputOptions = (names: readonly string[]) => names.map((input) => ({ value: input, text: symbol(input) === input ? input : `${symbol(input)} · ${input}` }));

function chosenPoints(points: Points, isChosen: (status: Points["status"][number]) => boolean): Points {
  const places = points.index.map((_, k) => k).filter((k) => isChosen(points.status[k] ?? "converged"));
  const of = <Value,>(column: readonly Value[]) => places.map((k) => column[k] as Value);
  return { index: of(points.index), status: of(points.status), x: of(points.x), y: of(points.y) };
}

function MapCard({ view, x, y, names, onChoose, shownAs }: {
  view: StudyView;
  x: string;
  y: string;
  names: readonly string[];
  onChoose: (x: string, y: string) => void;
  shownAs: string | undefined;
}) {
  const id = view.summary.study.id;
  const { source } = usePage();
  const isWhole = view.sample.index.length >= view.sample.of;
  const [chosen, setShown] = useState<"points" | "bins" | null>(shownAs === "bins" || shownAs === "points" ? shownAs : null);
  const [picked, setPicked] = useState<number | null>(null);
  const points = usePoints(view, x, y);
  const axes = useMemo(() => {
    const along = (input: string) => view.marginals.find((each) => each.axis.input === input)?.axis ?? null;
    return [along(x), along(y)] as const;
  }, [view, x, y]);
  const places = (axes[0]?.levels?.length ?? Infinity) * (axes[1]?.levels?.length ?? Infinity);
  const isStacked = points.index.length > places; // failures would hide what converged at the same place
  const shown = chosen ?? (isWhole && !isStacked ? "points" : "bins");
  const options = inputOptions(names);
  const pick = (place: number) => {
    if (shown === "points") go({ view: "trial", id, index: points.index[place] ?? 0, t: null });
    else setPicked(place);
  };
  const choose = (nextX: string, nextY: string) => {
    setPicked(null);
    onChoose(nextX, nextY);
  };
  return (
    <Card
      class="map-card"
      title="Success over two inputs"
      actions={<Choice label="Shown as" value={shown} onChange={(as) => { setShown(as); setPicked(null); }} options={[{ value: "points", text: "Trials" }, { value: "bins", text: "Rates" }]} />}
    >
      <div class="controls">
        <Select label="Across" value={x} options={options} onChange={(next) => choose(next, next === y ? x : y)} />
        <Select label="Up" value={y} options={options} onChange={(next) => choose(next === x ? y : x, next)} />
        <button type="button" class="button quiet" onClick={() => choose(y, x)}>Exchange</button>
      </div>
      {shown === "points" && axes[0] && axes[1] ? (
        <>
          <Plane x={axes[0]} y={axes[1]} points={points} onPick={pick} canOpen={source.report ? (index) => source.has(index) : undefined} height={430} />
          <p class="legend">
            {statuses.filter((status) => view.summary.outcomes[status] > 0).map((status) => <StatusName key={status} status={status} />)}
          </p>
          <p class="note">
            {isWhole ? `All ${count(view.sample.of)} ${view.trials.used < view.trials.finished ? "independent " : ""}trials.` : `${count(view.sample.index.length)} of ${count(view.sample.of)} trials, chosen at random.`} {source.report ? "Those in rings are in this report: click one to see what happened in it." : "Click one to see what happened in it."}
            {isStacked && " Trials of the same two values lie upon one another, failures on top: the rates tell how many."}
          </p>
        </>
      ) : isWhole && axes[0] && axes[1] ? (
        <BinnedHere view={view} points={points} x={axes[0]} y={axes[1]} picked={picked} onPick={pick} />
      ) : (
        <BinnedThere view={view} points={points} x={x} y={y} picked={picked} onPick={pick} />
      )}
    </Card>
  );
}

function usePoints(view: StudyView, x: string, y: string): Points {
  return useMemo(() => {
    const column = (input: string) => view.sample.inputs[view.inputs.findIndex((each) => each.input === input)] ?? [];
    return { index: view.sample.index, status: view.sample.status.map((code) => statuses[code] ?? "converged"), x: column(x), y: column(y) };
  }, [view, x, y]);
}

/** Bins of the trials at hand, which are all. */
function BinnedHere({ view, points, x, y, picked, onPick }: { view: StudyView; points: Points; x: Axis; y: Axis; picked: number | null; onPick: (bin: number) => void }) {
  const most = Math.max(4, Math.min(24, Math.round(Math.sqrt(view.sample.of / 8))));
  const [ax, ay] = useMemo(() => [coarser(x, most), coarser(y, most)], [x, y, most]);
  const bins = useMemo(() => binPlane(ax, ay, points.x, points.y, points.status.map((status) => status === "converged")), [ax, ay, points]);
  return <BinnedMap id={view.summary.study.id} points={points} x={ax} y={ay} bins={bins} picked={picked} onPick={onPick} of={view.sample.of} />;
}

/** Bins of all trials, which the source has counted. */
function BinnedThere({ view, points, x, y, picked, onPick }: { view: StudyView; points: Points; x: string; y: string; picked: number | null; onPick: (bin: number) => void }) {
  const { source } = usePage();
  const id = view.summary.study.id;
  const loaded = useDocument<MapView>(`${id} ${x} ${y}`, (signal) => source.map(id, x, y, signal), view.trials.finished);
  if (loaded.value === null) return loaded.problem ? <ProblemBox problem={loaded.problem} /> : <Loading height={480} />;
  const map = loaded.value;
  return <BinnedMap id={id} points={points} x={map.x} y={map.y} bins={map} picked={picked} onPick={onPick} of={map.of} />;
}

function BinnedMap({ id, points, x, y, bins, picked, onPick, of }: {
  id: string;
  points: Points;
  x: Axis;
  y: Axis;
  bins: { trials: number[]; successes: number[]; outside: number };
  picked: number | null;
  onPick: (bin: number) => void;
  of: number;
}) {
  const { source } = usePage();
  const inside = useMemo(() => {
    if (picked === null) return [];
    const columns = (x.levels ?? x.edges?.slice(1) ?? []).length;
    const here = points.index.map((_, k) => k).filter((k) => binOf(y, points.y[k] ?? NaN) * columns + binOf(x, points.x[k] ?? NaN) === picked);
    const failedFirst = (k: number) => (points.status[k] === "converged" ? 1 : 0);
    return here.sort((a, b) => failedFirst(a) - failedFirst(b) || (points.index[a] ?? 0) - (points.index[b] ?? 0)).slice(0, 12);
  }, [picked, points, x, y]);
  const told = picked === null ? null : describeBin(x, y, bins, picked);
  return (
    <>
      <Plane x={x} y={y} bins={bins} onPick={onPick} picked={picked} height={430} />
      <RateLegend />
      <div class="look" aria-live="polite">
        {told ? (
          <>
            <strong>{told.along.join(", ")}</strong>: {told.rate}{told.interval && `, ${told.interval}`}.{" "}
            {inside.filter((k) => source.has(points.index[k] ?? -1)).map((k) => (
              <a key={k} class="listed" href={trialLink(id, points.index[k] ?? 0)}>
                <StatusName status={points.status[k] ?? "converged"} /> {points.index[k]}
              </a>
            ))}
          </>
        ) : (
          <span class="muted">All {count(of)} trials{bins.outside > 0 ? `, but ${count(bins.outside)} beyond the axes` : ""}. Click a bin for its trials.</span>
        )}
      </div>
    </>
  );
}

