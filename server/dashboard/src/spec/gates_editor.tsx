import { useId } from "preact/hooks";
import { metricName } from "../names";
import { metricNames, rateNames } from "./fields";
import { type Edited, Mistakes, mistakesAt } from "./inputs";
import { type Json, isObject, toPointer } from "./pointer";

/** What the statistics must show: a row a gate. Scope and cell of a gate stay as the JSON says. */
export function GatesEditor({ edited }: { edited: Edited }) {
  const id = useId();
  const value = edited.get(["gates"]);
  const gates = Array.isArray(value) ? value : [];
  const put = (next: Json[]) => edited.set(["gates"], next.length > 0 ? next : undefined);
  const change = (k: number, key: string, text: string) => put(gates.map((gate, at) => (at === k && isObject(gate) ? { ...gate, [key]: text } : gate)));
  const text = (gate: Json, key: string) => (isObject(gate) && typeof gate[key] === "string" ? gate[key] : "");
  return (
    <div class="gates-editor" data-pointer="/gates">
      {gates.map((gate, k) => {
        const mistakes = mistakesAt(edited.mistakes, ["gates", String(k)]);
        const metric = text(gate, "metric");
        return (
          <div key={k} class={`gate-row ${mistakes.length > 0 ? "wrong" : ""}`} data-pointer={toPointer(["gates", String(k)])}>
            <select aria-label={`Gate ${k + 1}: metric`} value={metric} aria-describedby={mistakes.length > 0 ? `${id}-${k}` : undefined} onChange={(event) => change(k, "metric", event.currentTarget.value)}>
              {!rateNames.includes(metric) && !metricNames.includes(metric) && <option value={metric}>{metric}</option>}
              <optgroup label="Rates">{rateNames.map((name) => <option key={name} value={name}>{name.replace(/_/g, " ")}</option>)}</optgroup>
              <optgroup label="Metrics">{metricNames.map((name) => <option key={name} value={name}>{metricName(name)}</option>)}</optgroup>
            </select>
            <input type="text" aria-label={`Gate ${k + 1}: comparison`} value={text(gate, "expr")} placeholder={rateNames.includes(metric) ? "ci_low >= 0.99" : "p95 < 120"} aria-invalid={mistakes.length > 0} aria-describedby={mistakes.length > 0 ? `${id}-${k}` : undefined} onInput={(event) => change(k, "expr", event.currentTarget.value)} />
            <button type="button" class="button quiet" aria-label={`Take gate ${k + 1} away`} onClick={() => put(gates.filter((_, at) => at !== k))}>Remove</button>
            <Mistakes mistakes={mistakes} id={`${id}-${k}`} />
          </div>
        );
      })}
      <button type="button" class="button" onClick={() => put([...gates, { metric: "success_rate", expr: "ci_low >= 0.99" }])}>Add a gate</button>
    </div>
  );
}
