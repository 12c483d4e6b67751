import type { ComponentChildren } from "preact";
import { useId } from "preact/hooks";
import { type Section, horizonField, nameField, samplingMethods, sections } from "./fields";
import { CorrelationEditor, correlationPath } from "./correlation_editor";
import { GatesEditor } from "./gates_editor";
import { GoalsEditor } from "./goals_editor";
import { ListedEditor } from "./listed_editor";
import { type Edited, FieldEditor, Mistakes, ReadInput, mistakesAt } from "./inputs";
import { prose } from "../names";
import { type Path, isObject, isWithin } from "./pointer";
import { parseNumber } from "./value";

/** The spec as a form. */
export function SpecForm({ edited }: { edited: Edited }) {
  return (
    <div class="spec-form">
      <div class="form-top">
        <FieldEditor field={nameField} edited={edited} name="Name" />
        <Sampling edited={edited} />
        <FieldEditor field={horizonField} edited={edited} name="Horizon" />
      </div>
      {sections.slice(0, 3).map((section) => <SchemaSection key={section.key} section={section} edited={edited} />)}
      <FormSection path={correlationPath} title="Correlations" description="Which drawn inputs go together, by a Gaussian copula: each keeps its distribution." isOpen={false} edited={edited}>
        <CorrelationEditor edited={edited} />
      </FormSection>
      <FormSection path={["gates"]} title="Gates" description="What the statistics must show: pass, fail or inconclusive." isOpen={false} edited={edited}>
        <GatesEditor edited={edited} />
      </FormSection>
      {sections.slice(3).map((section) => <SchemaSection key={section.key} section={section} edited={edited} />)}
    </div>
  );
}

const stopping = "Ends the study once the interval of every goal is narrow enough, in every cell; with Monte Carlo sampling alone.";

function SchemaSection({ section, edited }: { section: Section; edited: Edited }) {
  return (
    <FormSection path={[section.key]} title={section.title} description={section.key === "stop" ? stopping : section.description} isOpen={section.isOpen} edited={edited}>
      {section.key === "stop" && <GoalsEditor edited={edited} />}
      {section.fields.map((field) => <FieldEditor key={field.path.join(".")} field={field} edited={edited} />)}
    </FormSection>
  );
}

function FormSection({ path, title, description, isOpen, edited, children }: { path: Path; title: string; description: string; isOpen: boolean; edited: Edited; children: ComponentChildren }) {
  const value = edited.get(path);
  const size = isObject(value) ? Object.keys(value).length : Array.isArray(value) ? value.length : value === undefined ? 0 : 1;
  const mistakes = mistakesAt(edited.mistakes, path);
  return (
    <details class="form-section" open={isOpen || size > 0 || mistakes.length > 0}>
      <summary><span>{title}</span>{size > 0 && <span class="badge">{size} set</span>}{mistakes.length > 0 && <span class="badge wrong">{mistakes.length} wrong</span>}</summary>
      <p class="note">{prose(description)}</p>
      {children}
    </details>
  );
}

function Sampling({ edited }: { edited: Edited }) {
  const id = useId();
  const method = edited.get(["sampling", "method"]);
  const chosen = typeof method === "string" ? method : "monte_carlo";
  const trials = edited.get(["sampling", "trials"]);
  const seed = edited.get(["sampling", "seed"]);
  const mistakes = mistakesAt(edited.mistakes, ["sampling"]).filter(({ pointer }) => !isWithin(pointer, correlationPath));
  const isWrong = (key: string) => mistakesAt(mistakes, ["sampling", key]).length > 0;
  const described = mistakes.length > 0 ? id : undefined;
  const whole = (text: string) => {
    if (text.trim() === "") return undefined;
    const value = parseNumber(text.replace(/,/g, ""));
    return value !== null && Number.isSafeInteger(value) ? value : null;
  };
  /** A list of trials is no number of them: what another method cannot read is left out. */
  const choose = (next: string) => {
    const before = edited.get(["sampling"]);
    const { trials: kept, ...rest } = isObject(before) ? before : {};
    const stays = kept !== undefined && (next === "explicit") === Array.isArray(kept) && next !== "grid";
    edited.set(["sampling"], { ...rest, method: next, ...(stays ? { trials: kept } : {}) });
  };
  return (
    <div class={`field sampling ${mistakes.length > 0 ? "wrong" : ""}`} data-pointer="/sampling">
      <div class="field-name"><span>Sampling</span><span class="field-hint">How the numbers that vary get their values</span></div>
      <div class="field-control">
        <select aria-label="Sampling: method" value={chosen} aria-invalid={isWrong("method")} aria-describedby={described} onChange={(event) => choose(event.currentTarget.value)}>
          {samplingMethods.map((each) => <option key={each.value} value={each.value}>{each.text}</option>)}
        </select>
        {chosen !== "grid" && chosen !== "explicit" && (
          <ReadInput label={chosen === "sobol_indices" ? "Rows" : "Trials"} value={typeof trials === "number" ? trials : undefined} show={String} read={whole} onValue={(next) => edited.set(["sampling", "trials"], next)} placeholder="1" wrong="a whole number" inputMode="numeric" isInvalid={isWrong("trials")} describedBy={described} />
        )}
        <ReadInput label="Seed" value={typeof seed === "number" ? seed : undefined} show={String} read={whole} onValue={(next) => edited.set(["sampling", "seed"], next)} placeholder="1" wrong="a whole number" inputMode="numeric" isInvalid={isWrong("seed")} describedBy={described} />
        {chosen === "explicit" && <ListedEditor edited={edited} isInvalid={isWrong("trials")} describedBy={described} />}
      </div>
      <Mistakes mistakes={mistakes} id={id} />
    </div>
  );
}
