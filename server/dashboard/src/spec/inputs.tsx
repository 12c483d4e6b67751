import { useEffect, useId, useState } from "preact/hooks";
import type { ComponentChildren } from "preact";
import { prose, symbol, unitText } from "../names";
import { number } from "../numbers";
import type { Mistake } from "../problem";
import type { Field } from "./fields";
import { type Json, type Path, isWithin, toPointer } from "./pointer";
import { type ValueKind, begin, build, centre, isRelative, kindOf, kindWords, parseNumber, parseNumbers, partsOf, places, valueKinds } from "./value";

export interface Edited {
  get(path: Path): Json | undefined;
  set(path: Path, value: Json | undefined): void;
  mistakes: readonly Mistake[];
}

/** The mistakes at a place or within, below what they are about. */
export function Mistakes({ mistakes, id }: { mistakes: readonly Mistake[]; id: string }) {
  if (mistakes.length === 0) return null;
  return <div id={id} class="mistakes">{mistakes.map((mistake) => <p key={mistake.pointer + mistake.detail}>{mistake.detail}</p>)}</div>;
}

export const mistakesAt = (mistakes: readonly Mistake[], path: Path) => mistakes.filter((mistake) => isWithin(mistake.pointer, path));

/** A text field that hands on what can be read as a value, and says so where it cannot. */
export function ReadInput<Value>({ label, value, show, read, onValue, placeholder = "", wrong, isInvalid = false, describedBy, inputMode = "decimal", isHidden = false }: {
  label: string;
  value: Value | undefined;
  show: (value: Value) => string;
  /** null where the text is none; undefined for nothing. */
  read: (text: string) => Value | null | undefined;
  onValue: (value: Value | undefined) => void;
  placeholder?: string;
  wrong: string;
  isInvalid?: boolean;
  describedBy?: string | undefined;
  inputMode?: "decimal" | "numeric" | "text";
  isHidden?: boolean;
}) {
  const id = useId();
  const shownValue = value === undefined ? "" : show(value);
  const [text, setText] = useState(shownValue);
  const parsed = read(text);
  useEffect(() => {
    // Follows the spec, but does not rewrite what is being typed ("0." is 0).
    const now = read(text);
    if ((now === undefined || now === null ? "" : show(now)) !== shownValue && now !== null) setText(shownValue);
  }, [shownValue]);
  const bad = parsed === null;
  return (
    <label class={`field-input ${bad || isInvalid ? "wrong" : ""}`}>
      <span class={isHidden ? "unseen" : ""}>{label}</span>
      <input type="text" inputMode={inputMode} value={text} placeholder={placeholder} aria-invalid={bad || isInvalid} aria-describedby={bad ? id : describedBy}
        onInput={(event) => {
          const next = event.currentTarget.value;
          setText(next);
          const got = read(next);
          if (got !== null) onValue(got);
        }}
        onBlur={() => {
          if (parsed !== null) setText(shownValue);
        }} />
      {bad && <span class="mistakes" id={id}>{wrong}</span>}
    </label>
  );
}

const plain = (value: number) => String(value);
const plainText = (value: Json | undefined) => (typeof value === "string" ? value : JSON.stringify(value ?? ""));
const orNothing = <Value,>(read: (text: string) => Value | null) => (text: string) => (text.trim() === "" ? undefined : read(text));

function wholeNumber(text: string): number | null {
  const value = parseNumber(text);
  return value !== null && Number.isSafeInteger(value) ? value : null;
}

/** One field of the spec with its label, kind and mistakes. */
export function FieldEditor({ field, edited, name }: { field: Field; edited: Edited; name?: string }) {
  const id = useId();
  const value = edited.get(field.path);
  const mistakes = mistakesAt(edited.mistakes, field.path);
  const described = mistakes.length > 0 ? id : undefined;
  const input = field.path.join(".");
  const title = name ?? (field.kind === "value" || ["nominal", "goal"].includes(field.path[0] ?? "") ? symbol(input.replace(/^nominal/, "plant").replace(/^goal/, "plant")) : words(field.path));
  const hint = prose(field.description).replace(/\.$/, "");
  const isLong = hint.length > 150; // more than stands beside one line of fields
  const invalid = mistakes.length > 0;
  const set = (next: Json | undefined) => edited.set(field.path, next);
  const placeholder = field.default === undefined ? "" : typeof field.default === "number" ? number(field.default, 6) : plainText(field.default);
  let control: ComponentChildren;
  switch (field.kind) {
    case "value":
      control = <ValueEditor field={field} value={value} onValue={set} title={title} isInvalid={invalid} describedBy={described} />;
      break;
    case "number":
    case "integer":
      control = (
        <ReadInput label={title} isHidden value={typeof value === "number" ? value : undefined} show={plain} read={orNothing(field.kind === "integer" ? wholeNumber : parseNumber)} onValue={set}
          placeholder={placeholder} wrong={field.kind === "integer" ? "a whole number" : "a number"} isInvalid={invalid} describedBy={described} />
      );
      break;
    case "text":
      control = <ReadInput label={title} isHidden value={typeof value === "string" ? value : undefined} show={String} read={orNothing((text) => text)} onValue={set} placeholder={placeholder} wrong="" isInvalid={invalid} describedBy={described} inputMode="text" />;
      break;
    case "choice":
      control = (
        <select aria-label={title} aria-invalid={invalid} aria-describedby={described} value={typeof value === "string" ? value : ""} onChange={(event) => set(event.currentTarget.value || undefined)}>
          <option value="">{plainText(field.default).replace(/_/g, " ")} (default)</option>
          {field.choices.map((choice) => <option key={choice} value={choice}>{choice.replace(/_/g, " ")}</option>)}
        </select>
      );
      break;
    case "flag":
      control = <input type="checkbox" aria-label={title} checked={value === undefined ? field.default === true : value === true} onChange={(event) => set(event.currentTarget.checked === field.default ? undefined : event.currentTarget.checked)} />;
      break;
  }
  return (
    <div class={`field ${invalid ? "wrong" : ""} ${value !== undefined ? "is-set" : ""}`} data-pointer={toPointer(field.path)}>
      <div class="field-name" title={hint}>
        <span class={isWords(title) ? "words" : ""}>{title}{field.unit !== "1" && <span class="muted"> [{unitText(field.unit)}]</span>}</span>
        {!isLong && <span class="field-hint">{hint}</span>}
      </div>
      <div class="field-control">{control}</div>
      {isLong && <p class="field-hint long">{hint}</p>}
      <Mistakes mistakes={mistakes} id={id} />
    </div>
  );
}

/** Words are shown with a capital, and symbols as they are. */
const isWords = (title: string) => /^[a-z]{4}|^[a-z]{3} /.test(title);

const words = (path: Path) => path.slice(1).filter((part) => part !== "trajectories").join(" ").replace(/_/g, " ") || (path[0] ?? "").replace(/_/g, " ");

function ValueEditor({ field, value, onValue, title, isInvalid, describedBy }: {
  field: Field;
  value: Json | undefined;
  onValue: (value: Json | undefined) => void;
  title: string;
  isInvalid: boolean;
  describedBy: string | undefined;
}) {
  const kind = kindOf(value);
  const parts = partsOf(value, kind);
  const relative = isRelative(value);
  const standard = typeof field.default === "number" ? field.default : nominal(field.path);
  const canBeRelative = field.canBeRelative && !["default", "number", "sweep", "other"].includes(kind);
  const change = (next: ValueKind) => onValue(build(next, begin(next, centre(value, relative ? 1 : standard)), relative));
  return (
    <div class="value">
      <select class="value-kind" aria-label={`${title}: kind`} value={kind} aria-invalid={isInvalid} aria-describedby={describedBy} onChange={(event) => change(event.currentTarget.value as ValueKind)}>
        {valueKinds.filter((each) => each !== "other" || kind === "other").map((each) => (
          <option key={each} value={each} disabled={each === "other"}>{each === "default" ? `default${typeof field.default === "number" ? `: ${number(field.default, 4)}` : field.canBeRelative ? ": nominal" : ""}` : kindWords[each]}</option>
        ))}
      </select>
      {places[kind].map((place) => {
        const label = place.replace("[]", "");
        const put = (next: Json | undefined) => {
          if (next !== undefined) onValue(build(kind, { ...parts, [place]: next }, relative));
        };
        return place.endsWith("[]") ? (
          <ReadInput key={`${kind} ${place}`} label={label} value={parts[place] as number[] | undefined} show={(list) => list.join(", ")} read={parseNumbers} onValue={put} wrong="numbers, with commas" isInvalid={isInvalid} describedBy={describedBy} inputMode="text" />
        ) : (
          <ReadInput key={`${kind} ${place}`} label={label} isHidden={kind === "number"} value={parts[place] as number | undefined} show={plain} read={parseNumber} onValue={put} wrong="a number" isInvalid={isInvalid} describedBy={describedBy} />
        );
      })}
      {canBeRelative && (
        <label class="check" title="Draws multiply the nominal value">
          <input type="checkbox" checked={relative} onChange={(event) => onValue(build(kind, parts, event.currentTarget.checked))} /> × nominal
        </label>
      )}
    </div>
  );
}

const nominal = (path: Path) => ({ m1: 1, m2: 1, d2: 0.5, I2: 1 })[path[path.length - 1] ?? ""] ?? 0;
