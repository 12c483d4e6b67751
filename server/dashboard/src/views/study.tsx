import { useEffect, useRef, useState } from "preact/hooks";
import { type StudyState, type StudyView, isActive } from "../documents";
import { rememberFailed } from "../failed_trials";
import { useStudyState } from "../live";
import { useDocument, usePage } from "../page_context";
import { count, duration, number } from "../numbers";
import { Empty, ProblemBox, Progress, Shown, StateChip } from "../parts";
import { type Tab, studyLink, toFragment } from "../route";
import { Overview } from "./overview";
import { StudyActions } from "./study_actions";
import { TrialsTab } from "./trials";
import { WhyTab } from "./why";
import { compareLink } from "./studies";

/** The least time between looks at a running study's trials [ms]. */
const lookEvery = 2000;

export function StudyPage({ id, tab, query }: { id: string; tab: Tab; query: Readonly<Record<string, string>> }) {
  const { source } = usePage();
  const { state, problem, refresh } = useStudyState(id);
  const revision = useSlowly(state ? `${state.status} ${state.progress.completed}` : "", state !== null && isActive(state) ? lookEvery : 0);
  const loaded = useDocument<StudyView>(id, (signal) => source.study(id, signal), revision);
  const failed = loaded.value?.failed.index;
  useEffect(() => {
    if (failed) rememberFailed(id, failed);
  }, [id, failed]);
  const name = state?.name ?? loaded.value?.summary.study.name;
  useEffect(() => {
    document.title = name ? `${name} · steerstat` : "steerstat";
    return () => {
      document.title = "steerstat";
    };
  }, [name]);
  if (problem?.status === 404) {
    return (
      <Empty title="There is no such study" isWhole>
        <p>It was deleted, or the link is of another service: <code>{id}</code>.</p>
        <p><a class="button" href="#/">All studies</a></p>
      </Empty>
    );
  }
  const hasTrials = loaded.value === null || loaded.value.trials.finished > 0;
  return (
    <div class="page study">
      <StudyHead id={id} name={name ?? id} state={state} view={loaded.value} onChange={refresh} />
      <nav class="tabs" aria-label="Views of the study">
        {([["overview", "Overview"], ["why", "Why it fails"], ["trials", "Trials"]] as const).map(([each, text]) => (
          <a key={each} href={studyLink(id, each)} aria-current={tab === each ? "page" : undefined}>{text}</a>
        ))}
      </nav>
      {state?.failure && <ProblemBoxOf state={state} />}
      {loaded.problem && loaded.value === null && state !== null && isActive(state) ? (
        <NoTrials state={state} />
      ) : (
        <Shown loaded={loaded} height={640}>
          {(view) =>
            !hasTrials ? (
              <NoTrials state={state} />
            ) : tab === "overview" ? <Overview view={view} /> : tab === "why" ? <WhyTab view={view} query={query} /> : <TrialsTab view={view} query={query} />
          }
        </Shown>
      )}
      {problem && !problem.isLost && <ProblemBox problem={problem} />}
    </div>
  );
}

function NoTrials({ state }: { state: StudyState | null }) {
  if (state !== null && !isActive(state)) {
    return <Empty title={`It ${state.status === "cancelled" ? "was cancelled" : "ended"} before a trial finished`}><p>The same spec runs it again.</p><p><a class="button" href={toFragment({ view: "new", from: state.id })}>Open its spec</a></p></Empty>;
  }
  if (state !== null && state.progress.completed > 0) return <Empty title="The first figures are on their way"><p>Trials have finished; what they say is being counted.</p></Empty>;
  return <Empty title="No trial has finished yet"><p>{state?.status === "queued" ? "It waits for its turn." : "The first figures come with the first trials."}</p></Empty>;
}

function ProblemBoxOf({ state }: { state: StudyState }) {
  return (
    <div class="problem" role="alert">
      <strong>This study failed</strong>
      <p>{state.failure}</p>
      <p>What was finished is kept. The same spec posted again goes on from there.</p>
    </div>
  );
}

function StudyHead({ id, name, state, view, onChange }: { id: string; name: string; state: StudyState | null; view: StudyView | null; onChange: () => void }) {
  const { source } = usePage();
  const completed = state?.progress.completed ?? view?.trials.finished ?? 0;
  const requested = state?.progress.requested ?? view?.trials.requested ?? 0;
  const running = state !== null && isActive(state);
  const summary = view?.summary;
  return (
    <div class="page-head">
      <div>
        <p class="crumbs">{!source.report && <><a href="#/">Studies</a> <span aria-hidden="true">/</span> </>}<code class="id">{id}</code></p>
        <h1>{name}</h1>
        <p class="facts">
          {state && <StateChip state={state.status} />}
          <span>{count(completed)}{completed !== requested && ` of ${count(requested)}`} {requested === 1 ? "trial" : "trials"}</span>
          {summary && <span>seed {summary.study.seed}</span>}
          {summary && <span>engine {summary.study.engine_version}</span>}
          {!running && summary?.performance.trials_per_s && <span>{number(summary.performance.trials_per_s, 3)} trials/s</span>}
          {running && state.progress.trials_per_s !== null && <span>{number(state.progress.trials_per_s, 3)} trials/s</span>}
          {running && state.progress.eta_s !== null && <span>{duration(state.progress.eta_s)} left</span>}
        </p>
        <div class="head-progress">{running && <Progress completed={completed} requested={requested} label="Progress" />}</div>
      </div>
      {state && (
        <div class="page-actions">
          <a class="button quiet" href={compareLink(id, null)}>Compare</a>
          <StudyActions state={state} onChange={onChange} />
        </div>
      )}
    </div>
  );
}

/** A value that follows another at most so often; at once where milliseconds are 0. */
function useSlowly(value: string, milliseconds: number): string {
  const [slow, setSlow] = useState(value);
  const last = useRef(0);
  useEffect(() => {
    const wait = Math.max(0, last.current + milliseconds - Date.now());
    const timer = setTimeout(() => {
      last.current = Date.now();
      setSlow(value);
    }, milliseconds === 0 ? 0 : wait);
    return () => clearTimeout(timer);
  }, [value, milliseconds]);
  return slow;
}
