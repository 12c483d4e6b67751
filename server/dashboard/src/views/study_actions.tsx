import { useEffect, useState } from "preact/hooks";
import { type StudyState, isActive } from "../documents";
import { toProblem, usePage } from "../page_context";
import { ServiceSource } from "../source";
import { toFragment } from "../route";

/** What can be done with a study: cancel or delete, run with more trials, take its result away. */
export function StudyActions({ state, onChange, isBrief = false }: { state: StudyState; onChange: () => void; isBrief?: boolean }) {
  const { source } = usePage();
  const [failure, setFailure] = useState("");
  const remove = async () => {
    try {
      await source.remove(state.id);
      setFailure("");
    } catch (error) {
      setFailure(toProblem(error).message);
    }
    onChange();
  };
  const name = state.name;
  return (
    <div class="actions">
      {isActive(state) ? (
        <SureButton text="Cancel" sure="Cancel it? What is finished is kept." label={`Cancel ${name}`} onSure={remove} />
      ) : (
        <>
          <Download id={state.id} name={name} isDone={state.status === "succeeded"} onFailure={setFailure} />
          <a class="button quiet" href={toFragment({ view: "new", from: state.id })} aria-label={`Extend or vary ${name}`} title="Its spec in the form: more trials, or another design">
            {isBrief ? "Extend" : "Extend or vary"}
          </a>
          <SureButton text="Delete" sure="Delete it and its trials?" label={`Delete ${name}`} onSure={remove} />
        </>
      )}
      {failure && <p class="failure" role="alert">{failure}</p>}
    </div>
  );
}

function Download({ id, name, isDone, onFailure }: { id: string; name: string; isDone: boolean; onFailure: (text: string) => void }) {
  const { source } = usePage();
  if (!(source instanceof ServiceSource) || !isDone) return null;
  const fileName = `${id}.h5`; // as the service calls it
  const fetchWithToken = async (event: Event) => {
    if (!source.hasToken) return; // the link does
    event.preventDefault();
    try {
      const url = URL.createObjectURL(await source.resultFile(id));
      const link = document.createElement("a");
      link.href = url;
      link.download = fileName;
      link.click();
      URL.revokeObjectURL(url);
    } catch (error) {
      onFailure(toProblem(error).message);
    }
  };
  return (
    <a class="button quiet" href={`v1/studies/${encodeURIComponent(id)}/results.h5`} download={fileName} onClick={fetchWithToken} aria-label={`Download the result file of ${name}`} title="Every trial, as HDF5">
      Download
    </a>
  );
}

/** A button that asks back, in its own place. */
export function SureButton({ text, sure, label, onSure }: { text: string; sure: string; label: string; onSure: () => void | Promise<void> }) {
  const [isAsking, setAsking] = useState(false);
  const [isBusy, setBusy] = useState(false);
  useEffect(() => {
    if (!isAsking) return;
    const timer = setTimeout(() => setAsking(false), 6000);
    return () => clearTimeout(timer);
  }, [isAsking]);
  const click = async () => {
    if (!isAsking) {
      setAsking(true);
      return;
    }
    setAsking(false);
    setBusy(true);
    await onSure();
    setBusy(false);
  };
  return (
    <button type="button" class={isAsking ? "button danger" : "button quiet"} disabled={isBusy} aria-label={isAsking ? `${sure} ${label}` : label} onClick={click} onBlur={() => setAsking(false)}>
      {isAsking ? sure : text}
    </button>
  );
}
