import { useEffect, useMemo, useState } from "preact/hooks";
import { counted } from "../numbers";
import { toProblem, usePage } from "../page_context";
import { Card, ProblemBox } from "../parts";
import type { Mistake, Problem } from "../problem";
import { go } from "../route";
import { Editor } from "../spec/editor";
import { allFields } from "../spec/fields";
import { SpecForm } from "../spec/form";
import { lineOf, locate } from "../spec/locate";
import { type Json, formatSpec, getAt, isWithin, setAt } from "../spec/pointer";
import { shipped } from "../spec/shipped";

const start = shipped.find((each) => each.name === "combined")?.text ?? "{}";

/** A new study: a form and its JSON, which are one. */
export function NewStudyView({ from }: { from: string | null }) {
  const { source, connection } = usePage();
  const [text, setText] = useState(start);
  const [before, setBefore] = useState<string | null>(null);
  const [isEdited, setEdited] = useState(false);
  const [mistakes, setMistakes] = useState<readonly Mistake[]>([]);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [isSending, setSending] = useState(false);
  const [jump, setJump] = useState<{ line: number } | null>(null);
  const located = useMemo(() => locate(text), [text]);
  const spec = useMemo<Json | null>(() => (located.mistake ? null : (JSON.parse(text) as Json)), [located]);

  useEffect(() => {
    document.title = "New study · steerstat";
    return () => {
      document.title = "steerstat";
    };
  }, []);
  useEffect(() => {
    if (from === null) return;
    const abort = new AbortController();
    source.spec(from, abort.signal).then(
      (got) => setText(formatSpec(got as Json)),
      (error: unknown) => {
        if (!abort.signal.aborted) setProblem(toProblem(error));
      },
    );
    return () => abort.abort();
  }, [from, source]);

  const edit = (next: string) => {
    setText(next);
    setEdited(true);
    setMistakes([]); // they are of what was sent
    setProblem(null);
  };
  const replace = (next: string) => {
    setBefore(isEdited ? text : null);
    setText(next);
    setEdited(false);
    setMistakes([]);
    setProblem(null);
  };
  const submit = async () => {
    setSending(true);
    try {
      const state = await source.submit(text);
      connection.note(null);
      go({ view: "study", id: state.id, tab: "overview", query: {} });
    } catch (error) {
      const why = toProblem(error);
      connection.note(why);
      setProblem(why);
      setMistakes(why.mistakes);
      setSending(false);
      if (why.mistakes.length > 0) requestAnimationFrame(() => document.getElementById("refused")?.focus());
    }
  };
  const show = (mistake: Mistake) => {
    const field = allFields.filter((each) => isWithin(mistake.pointer, each.path)).map((each) => `/${each.path.join("/")}`)[0] ?? mistake.pointer;
    const place = [...document.querySelectorAll<HTMLElement>("[data-pointer]")].filter((each) => field === each.dataset.pointer || field.startsWith(`${each.dataset.pointer}/`)).pop();
    if (!place) {
      setJump({ line: lineOf(located, mistake.pointer) });
      return;
    }
    place.closest("details")?.setAttribute("open", "");
    place.scrollIntoView({ block: "center", behavior: "smooth" });
    place.querySelector<HTMLElement>("select, input")?.focus({ preventScroll: true });
  };

  const run = (place: string) => (
    <div class={place}><button type="button" class="button primary" disabled={isSending || spec === null} onClick={submit}>{isSending ? "Sending…" : "Run the study"}</button></div>
  );

  return (
    <div class="page new-study">
      <div class="page-head">
        <div>
          <h1>New study</h1>
          <p class="lead">Any number may be fixed, drawn from a distribution or swept. What you leave out has its default.</p>
        </div>
        <div class="page-actions">
          <label class="select"><span>Start from</span>
            <select value="" onChange={(event) => {
              const chosen = shipped[Number(event.currentTarget.value)];
              event.currentTarget.value = "";
              if (chosen) replace(chosen.text);
            }}>
              <option value="">{from === null ? "a shipped spec…" : "another…"}</option>
              {[...new Set(shipped.map((each) => each.group))].map((group) => (
                <optgroup key={group} label={group}>
                  {shipped.map((each, k) => each.group === group && <option key={each.name} value={String(k)}>{each.name.replace(/_/g, " ")}</option>)}
                </optgroup>
              ))}
            </select>
          </label>
          {before !== null && <button type="button" class="button quiet" onClick={() => { edit(before); setBefore(null); }}>Undo</button>}
          {run("run-above")}
        </div>
      </div>
      {from !== null && <p class="note">The spec of study <code class="id">{from}</code>. With more trials and nothing else changed, those that are finished are taken over.</p>}
      {problem && (
        <div id="refused" tabIndex={-1}>
          <ProblemBox problem={problem} title={mistakes.length > 0 ? `The spec has ${counted(mistakes.length, "mistake")}` : problem.title} detail={mistakes.length > 0 ? "" : problem.detail}>
            {mistakes.length > 0 && (
              <ul>
                {mistakes.map((mistake) => (
                  <li key={mistake.pointer + mistake.detail}>
                    <button type="button" class="link" onClick={() => show(mistake)}><code>{mistake.pointer || "/"}</code></button> {mistake.detail}
                  </li>
                ))}
              </ul>
            )}
            {problem.retryAfter !== null && <p>Try again in {problem.retryAfter} s.</p>}
          </ProblemBox>
        </div>
      )}
      <div class="split">
        <Card title="Form" class="form-card">
          {spec === null ? (
            <div class="problem" role="status"><strong>The JSON has a mistake in line {located.mistake?.line}</strong><p>{located.mistake?.detail}. The form is back as soon as it is mended.</p></div>
          ) : (
            <SpecForm edited={{
              get: (path) => getAt(spec, path),
              set: (path, value) => edit(formatSpec(setAt(spec, path, value))),
              mistakes,
            }} />
          )}
        </Card>
        <Card title="JSON" class="json-card" actions={<button type="button" class="button quiet" disabled={spec === null} onClick={() => spec !== null && edit(formatSpec(spec))}>Tidy</button>}>
          <Editor text={text} located={located} mistakes={mistakes} onChange={edit} jump={jump} />
        </Card>
      </div>
      {run("run-below")}
    </div>
  );
}
