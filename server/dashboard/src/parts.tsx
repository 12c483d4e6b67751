// Small parts that views are put together from.
import { type ComponentChildren, Fragment } from "preact";
import { useEffect, useState } from "preact/hooks";
import type { Status, StudyState } from "./documents";
import type { Loaded } from "./page_context";
import { statusWords } from "./names";
import type { Problem } from "./problem";

export function Card({ title, note, actions, children, class: name = "" }: {
  title?: ComponentChildren;
  note?: ComponentChildren;
  actions?: ComponentChildren;
  children: ComponentChildren;
  class?: string;
}) {
  return (
    <section class={`card ${name}`}>
      {(title || actions) && (
        <header class="card-head">
          {title && <h2>{title}</h2>}
          {actions && <div class="card-actions">{actions}</div>}
        </header>
      )}
      {children}
      {note && <p class="note">{note}</p>}
    </section>
  );
}

/** The mark of a status: its shape tells it too. */
export function StatusMark({ status }: { status: Status }) {
  const shapes: Record<Status, ComponentChildren> = {
    converged: <circle cx="6" cy="6" r="4.5" fill="currentColor" />,
    timeout: <path d="M2 2 10 10M10 2 2 10" stroke="currentColor" stroke-width="2.2" fill="none" />,
    singular: <path d="M6 0.8 11.2 6 6 11.2 0.8 6Z" fill="currentColor" />,
    diverged: <path d="M6 1 11.4 10.6H0.6Z" fill="currentColor" />,
    integrator_failed: <rect x="1.6" y="1.6" width="8.8" height="8.8" fill="currentColor" />,
  };
  return (
    <svg class={`mark status-${status}`} viewBox="0 0 12 12" width="12" height="12" aria-hidden="true">
      {shapes[status]}
    </svg>
  );
}

export function StatusName({ status }: { status: Status }) {
  return (
    <span class="status-name">
      <StatusMark status={status} /> {statusWords[status]}
    </span>
  );
}

const stateWords: Record<StudyState["status"], string> = {
  queued: "queued",
  running: "running",
  succeeded: "done",
  failed: "failed",
  cancelled: "cancelled",
};

export function StateChip({ state }: { state: StudyState["status"] }) {
  return <span class={`chip state-${state}`}>{stateWords[state]}</span>;
}

export function Progress({ completed, requested, label }: { completed: number; requested: number; label: string }) {
  const share = requested > 0 ? Math.min(1, completed / requested) : 0;
  return (
    <div class="progress" role="progressbar" aria-label={label} aria-valuemin={0} aria-valuemax={100} aria-valuenow={Math.floor(100 * share)}>
      <div class="progress-done" style={{ transform: `scaleX(${share})` }} />
    </div>
  );
}

/** Shows what is loaded, or why there is nothing yet. */
export function Shown<Document>({ loaded, children, height = 420 }: {
  loaded: Loaded<Document>;
  children: (document: Document) => ComponentChildren;
  height?: number;
}) {
  if (loaded.value !== null) {
    return (
      <>
        {loaded.problem && !loaded.problem.isLost && <ProblemBox problem={loaded.problem} />}
        {children(loaded.value)}
      </>
    );
  }
  if (loaded.problem) return <ProblemBox problem={loaded.problem} />;
  return <Loading height={height} />;
}

/** Grey where something will be; only after a moment, so that what is quick does not flicker. */
export function Loading({ height }: { height: number }) {
  const [isSlow, setSlow] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setSlow(true), 150);
    return () => clearTimeout(timer);
  }, []);
  return (
    <div class={isSlow ? "loading slow" : "loading"} style={{ minHeight: `${height}px` }} role="status" aria-label="Loading">
      <div class="bone bone-title" />
      <div class="bone bone-block" />
      <div class="bone bone-line" />
    </div>
  );
}

export function ProblemBox({ problem, title = problem.title, detail = problem.detail, children }: { problem: Problem; title?: string; detail?: string; children?: ComponentChildren }) {
  return (
    <div class="problem" role="alert">
      <strong>{title}</strong>
      {detail && <p>{detail}</p>}
      {children === undefined && problem.mistakes.length > 0 && (
        <ul>{problem.mistakes.map(({ pointer, detail: why }) => <li key={pointer + why}>{pointer && <><code>{pointer}</code> </>}{why}</li>)}</ul>
      )}
      {children}
    </div>
  );
}

export function Empty({ title, isWhole = false, children }: { title: string; isWhole?: boolean; children?: ComponentChildren }) {
  return (
    <div class="empty">
      <RobotGlyph />
      {isWhole ? <h1>{title}</h1> : <strong>{title}</strong>}
      {children}
    </div>
  );
}

/** The robot in a few lines: a slide, a joint, a link. */
export function RobotGlyph() {
  return (
    <svg viewBox="0 0 96 48" width="96" height="48" aria-hidden="true" class="robot-glyph">
      <path d="M4 38H92" stroke="currentColor" stroke-width="2" stroke-dasharray="2 5" stroke-linecap="round" />
      <rect x="26" y="31" width="24" height="14" rx="3" fill="none" stroke="currentColor" stroke-width="2.5" />
      <path d="M38 38 66 10" stroke="currentColor" stroke-width="6" stroke-linecap="round" />
      <circle cx="38" cy="38" r="4" fill="currentColor" />
      <circle cx="66" cy="10" r="5" fill="none" stroke="currentColor" stroke-width="2.5" />
    </svg>
  );
}

/** One number with its name. */
export function Figure({ name, children, title }: { name: ComponentChildren; children: ComponentChildren; title?: string }) {
  return (
    <div class="figure" title={title}>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}

export function Select<Value extends string>({ label, value, options, onChange, isHidden = false }: {
  label: string;
  value: Value;
  options: readonly { value: Value; text: string }[];
  onChange: (value: Value) => void;
  /** Whether the label is for readers of screens alone. */
  isHidden?: boolean;
}) {
  return (
    <label class="select">
      <span class={isHidden ? "unseen" : ""}>{label}</span>
      <select value={value} onChange={(event) => onChange(event.currentTarget.value as Value)}>
        {options.map((option) => (
          <option key={option.value} value={option.value}>
            {option.text}
          </option>
        ))}
      </select>
    </label>
  );
}

/** A choice of few, all in sight. */
export function Choice<Value extends string>({ label, value, options, onChange }: {
  label: string;
  value: Value;
  options: readonly { value: Value; text: string; title?: string }[];
  onChange: (value: Value) => void;
}) {
  return (
    <div class="choice" role="group" aria-label={label}>
      {options.map((option) => (
        <button key={option.value} type="button" aria-pressed={option.value === value} title={option.title} onClick={() => onChange(option.value)}>
          {option.text}
        </button>
      ))}
    </div>
  );
}

/** Code that breaks its line after a separator, where it has to. */
export function BreakingCode({ text, at, class: name = "" }: { text: string; at: string; class?: string }) {
  return <code class={name}>{text.split(at).map((part, k) => (k === 0 ? part : <Fragment key={k}>{at}<wbr />{part}</Fragment>))}</code>;
}

