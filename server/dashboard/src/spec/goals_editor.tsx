import { useId } from "preact/hooks";
import { metricName } from "../names";
import { goalMetrics } from "./fields";
import { type Edited, Mistakes, ReadInput, mistakesAt } from "./inputs";
import { type Json, isObject, toPointer } from "./pointer";
import { parseNumber } from "./value";

const path = ["stop", "until"];
const isRate = (metric: string) => metric.endsWith("_rate");
const widths = { half_width: "half width", relative_half_width: "half width, relative" } as const;
type Width = keyof typeof widths;

/** What a stopping rule waits for: a row a goal, all of which must hold. */
export function GoalsEditor({ edited }: { edited: Edited }) {
  const id = useId();
  const value = edited.get(path);
  const goals = Array.isArray(value) ? value : [];
  const put = (next: Json[]) => (next.length > 0 ? edited.set(path, next) : edited.set(["stop"], undefined));
  const change = (k: number, changed: { [key: string]: Json | undefined }) => {
    const before = goals[k];
    const entries = Object.entries({ ...(isObject(before) ? before : {}), ...changed }).filter((entry): entry is [string, Json] => entry[1] !== undefined);
    put(goals.map((goal, at) => (at === k ? Object.fromEntries(entries) : goal)));
  };
  const read = (text: string) => (text.trim() === "" ? undefined : parseNumber(text));
  return (
    <div class="gates-editor" data-pointer={toPointer(path)}>
      {goals.map((goal, k) => {
        const parts = isObject(goal) ? goal : {};
        const metric = typeof parts.metric === "string" ? parts.metric : "";
        const width: Width = "relative_half_width" in parts ? "relative_half_width" : "half_width";
        const mistakes = mistakesAt(edited.mistakes, [...path, String(k)]);
        const described = mistakes.length > 0 ? `${id}-${k}` : undefined;
        const numberAt = (key: string) => (typeof parts[key] === "number" ? parts[key] : undefined);
        return (
          <div key={k} class={`goal-row ${mistakes.length > 0 ? "wrong" : ""}`} data-pointer={toPointer([...path, String(k)])}>
            <select aria-label={`Goal ${k + 1}: metric`} value={metric} aria-describedby={described}
              onChange={({ currentTarget: { value: next } }) => change(k, { metric: next, quantile: isRate(next) ? undefined : (parts.quantile ?? 0.5) })}>
              {!goalMetrics.includes(metric) && <option value={metric}>{metric}</option>}
              {goalMetrics.map((name) => <option key={name} value={name}>{isRate(name) ? name.replace(/_/g, " ") : metricName(name)}</option>)}
            </select>
            {isRate(metric) ? <span /> : <ReadInput label="quantile" value={numberAt("quantile")} show={String} read={read} onValue={(next) => change(k, { quantile: next })} placeholder="0.5" wrong="a number" describedBy={described} />}
            <select aria-label={`Goal ${k + 1}: kind of width`} value={width} onChange={({ currentTarget: { value: next } }) => change(k, { [width]: undefined, [next]: parts[width] ?? 0.01 })}>
              {Object.entries(widths).map(([key, text]) => <option key={key} value={key}>{text}</option>)}
            </select>
            <ReadInput label="at most" value={numberAt(width)} show={String} read={read} onValue={(next) => change(k, { [width]: next })} placeholder="0.01" wrong="a number" describedBy={described} />
            <button type="button" class="button quiet" aria-label={`Take goal ${k + 1} away`} onClick={() => put(goals.filter((_, at) => at !== k))}>Remove</button>
            <Mistakes mistakes={mistakes} id={`${id}-${k}`} />
          </div>
        );
      })}
      <button type="button" class="button" onClick={() => put([...goals, { metric: "success_rate", half_width: 0.01 }])}>Add a goal</button>
    </div>
  );
}
