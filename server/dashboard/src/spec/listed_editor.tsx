import { useEffect, useId, useState } from "preact/hooks";
import type { Edited } from "./inputs";
import { type ListedTrial, listedText, readListed } from "./listed";
import { type Json, isObject } from "./pointer";

export const listedPath = ["sampling", "trials"] as const;

const isListed = (value: Json | undefined): value is ListedTrial[] =>
  Array.isArray(value) && value.every((each) => isObject(each) && Object.values(each).every((cell) => typeof cell === "number"));

/** The trials of an explicit study, as a table that can be pasted from a spreadsheet's CSV. */
export function ListedEditor({ edited, isInvalid, describedBy }: { edited: Edited; isInvalid: boolean; describedBy: string | undefined }) {
  const id = useId();
  const value = edited.get([...listedPath]);
  const shown = isListed(value) ? listedText(value) : "";
  const [text, setText] = useState(shown);
  const read = readListed(text);
  useEffect(() => {
    // Follows the JSON, but does not rewrite what is being typed.
    if (typeof read !== "string" && (read === undefined ? "" : listedText(read)) !== shown) setText(shown);
  }, [shown]);
  const wrong = typeof read === "string" ? read : null;
  return (
    <label class={`field-input listed-input ${wrong || isInvalid ? "wrong" : ""}`}>
      <span>Trials: names in the first line, one trial in each after it</span>
      <textarea rows={6} spellcheck={false} value={text} placeholder={"plant.m1, initial_state.q2\n1.1, 0.3\n0.9, -0.3"} aria-invalid={wrong !== null || isInvalid} aria-describedby={wrong ? id : describedBy}
        onInput={(event) => {
          const next = event.currentTarget.value;
          setText(next);
          const got = readListed(next);
          if (typeof got !== "string") edited.set([...listedPath], got);
        }} />
      {wrong && <span class="mistakes" id={id}>{wrong}</span>}
    </label>
  );
}
