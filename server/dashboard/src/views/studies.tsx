import { useState } from "preact/hooks";
import { type StudyState, isActive } from "../documents";
import { type Studies, useNow, useStudies } from "../live";
import { ago, count, duration, number } from "../numbers";
import { Empty, Loading, ProblemBox, Progress, StateChip } from "../parts";
import { go, studyLink, toFragment } from "../route";
import { StudyActions } from "./study_actions";

export function StudiesView() {
  const list = useStudies();
  const [chosen, setChosen] = useState<string[]>([]);
  const now = useNow(10000);
  const { studies, problem } = list;
  const both = chosen.filter((id) => studies?.some((study) => study.id === id));
  return (
    <div class="page studies">
      <div class="page-head">
        <div>
          <h1>Studies</h1>
          <p class="lead">How often does the controller really work, and why not always?</p>
        </div>
        <div class="page-actions">
          {(studies?.length ?? 0) > 1 && (
            <button type="button" class="button" disabled={both.length !== 2} title="Choose two studies in the list" onClick={() => go({ view: "compare", a: both[0] ?? null, b: both[1] ?? null })}>
              Compare {both.length}/2
            </button>
          )}
        </div>
      </div>
      {problem && !problem.isLost && <ProblemBox problem={problem} />}
      {studies === null ? (
        !problem && <Loading height={360} />
      ) : studies.length === 0 ? (
        <Empty title="No study yet">
          <p>A study says what varies, how, and how often. Begin with one of the shipped ones.</p>
          <p><a class="button primary" href="#/new">New study</a></p>
        </Empty>
      ) : (
        <StudyTable list={list} studies={studies} now={now} chosen={both} onChoose={(id, isIn) => setChosen(isIn ? [...both, id].slice(-2) : both.filter((each) => each !== id))} />
      )}
    </div>
  );
}

function StudyTable({ list, studies, now, chosen, onChoose }: {
  list: Studies;
  studies: readonly StudyState[];
  now: number;
  chosen: readonly string[];
  onChoose: (id: string, isIn: boolean) => void;
}) {
  return (
    <>
      <table class="table study-table">
        <thead>
          <tr>
            <th scope="col"><span class="unseen">Compare</span></th>
            <th scope="col">Study</th>
            <th scope="col" class="column-state">State</th>
            <th scope="col" class="column-trials">Trials</th>
            <th scope="col" class="right wide-only column-rate">Trials/s</th>
            <th scope="col" class="wide-only column-created">Created</th>
            <th scope="col" class="column-actions"><span class="unseen">Actions</span></th>
          </tr>
        </thead>
        <tbody>
          {studies.map((study) => (
            <tr key={study.id}>
              <td class="cell-choose">
                <input type="checkbox" aria-label={`Choose ${study.name} for a comparison`} checked={chosen.includes(study.id)} onChange={(event) => onChoose(study.id, event.currentTarget.checked)} />
              </td>
              <td class="cell-name">
                <a href={studyLink(study.id)}>{study.name}</a>
                <code class="id">{study.id}</code>
              </td>
              <td class="cell-state"><StateChip state={study.status} /></td>
              <td class="cell-progress"><StudyProgress study={study} /></td>
              <td class="right wide-only">{study.progress.trials_per_s ? number(study.progress.trials_per_s, 3) : ""}</td>
              <td class="wide-only"><time dateTime={study.created} title={study.created}>{ago(study.created, now)}</time></td>
              <td class="cell-actions"><StudyActions state={study} onChange={list.refresh} isBrief /></td>
            </tr>
          ))}
        </tbody>
      </table>
      {list.hasMore && <p class="more"><button type="button" class="button" onClick={list.more}>More studies</button></p>}
    </>
  );
}

/** How far a study is; a failed one's reason in its place. */
export function StudyProgress({ study }: { study: StudyState }) {
  const { completed, requested, eta_s: left } = study.progress;
  if (study.status === "failed" && study.failure) return <p class="study-progress failed failure" title={study.failure}>{study.failure}</p>;
  return (
    <div class="study-progress">
      <span class="numbers">
        {count(completed)}{completed !== requested && <span class="muted"> of {count(requested)}</span>}
        {study.status === "running" && left !== null && completed < requested && <span class="muted"> · {duration(left)} left</span>}
      </span>
      {isActive(study) && <Progress completed={completed} requested={requested} label={`Progress of ${study.name}`} />}
    </div>
  );
}

export const compareLink = (a: string, b: string | null) => toFragment({ view: "compare", a, b });
