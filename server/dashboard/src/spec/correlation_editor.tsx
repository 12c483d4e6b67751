import { useId } from "preact/hooks";
import { symbol } from "../names";
import { allFields } from "./fields";
import { type Edited, Mistakes, ReadInput, mistakesAt } from "./inputs";
import { type Json, toPointer } from "./pointer";
import { kindOf, parseNumber } from "./value";

export const correlationPath = ["sampling", "correlation"];

/** Inputs that the spec draws, and so can be correlated. */
function drawnInputs(edited: Edited): string[] {
  return allFields.filter((field) => field.kind === "value" && !["default", "number", "sweep", "other"].includes(kindOf(edited.get(field.path)))).map((field) => field.path.join("."));
}

/** How inputs are drawn together: a row a pair, [input, input, correlation] in the spec. */
export function CorrelationEditor({ edited }: { edited: Edited }) {
  const id = useId();
  const value = edited.get(correlationPath);
  const pairs = Array.isArray(value) ? value : [];
  const drawn = drawnInputs(edited);
  const put = (next: Json[]) => edited.set(correlationPath, next.length > 0 ? next : undefined);
  const change = (k: number, place: number, part: Json) => put(pairs.map((pair, at) => (at === k && Array.isArray(pair) ? pair.map((each, p) => (p === place ? part : each)) : pair)));
  const isPaired = (a: string, b: string) => pairs.some((pair) => Array.isArray(pair) && pair.includes(a) && pair.includes(b));
  const free = drawn.flatMap((a, k) => drawn.slice(k + 1).map((b) => [a, b] as const)).find(([a, b]) => !isPaired(a, b));
  return (
    <div class="gates-editor" data-pointer={toPointer(correlationPath)}>
      {pairs.map((pair, k) => {
        const [a = "", b = "", r] = Array.isArray(pair) ? pair.map((each) => (typeof each === "number" || typeof each === "string" ? each : JSON.stringify(each))) : [];
        const mistakes = mistakesAt(edited.mistakes, [...correlationPath, String(k)]);
        const described = mistakes.length > 0 ? `${id}-${k}` : undefined;
        const choice = (place: 0 | 1, input: string | number, other: string | number) => (
          <select aria-label={`Correlation ${k + 1}: ${place === 0 ? "one" : "other"} input`} value={input} aria-describedby={described} onChange={(event) => change(k, place, event.currentTarget.value)}>
            {!drawn.includes(String(input)) && <option value={input}>{input}</option>}
            {drawn.filter((name) => name !== other).map((name) => <option key={name} value={name}>{symbol(name)} · {name}</option>)}
          </select>
        );
        return (
          <div key={k} class={`pair-row ${mistakes.length > 0 ? "wrong" : ""}`} data-pointer={toPointer([...correlationPath, String(k)])}>
            {choice(0, a, b)}
            {choice(1, b, a)}
            <ReadInput label="correlation" value={typeof r === "number" ? r : undefined} show={String} read={parseNumber} onValue={(next) => change(k, 2, next ?? 0)} placeholder="0.5" wrong="a number" describedBy={described} />
            <button type="button" class="button quiet" aria-label={`Take correlation ${k + 1} away`} onClick={() => put(pairs.filter((_, at) => at !== k))}>Remove</button>
            <Mistakes mistakes={mistakes} id={`${id}-${k}`} />
          </div>
        );
      })}
      <button type="button" class="button" disabled={!free} title={free ? "" : "Two inputs must be drawn that are not paired yet"} onClick={() => free && put([...pairs, [free[0], free[1], 0.5]])}>Add a correlation</button>
    </div>
  );
}
