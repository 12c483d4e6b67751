import { useEffect, useRef } from "preact/hooks";
import type { Mistake } from "../problem";
import { type Located, lineOf } from "./locate";

const lineHeight = 20;

/** The spec as JSON, with line numbers and the mistakes at their lines. */
export function Editor({ text, located, mistakes, onChange, jump }: {
  text: string;
  located: Located;
  mistakes: readonly Mistake[];
  onChange: (text: string) => void;
  /** A line to show; a new object each time. */
  jump: { line: number } | null;
}) {
  const area = useRef<HTMLTextAreaElement>(null);
  const gutter = useRef<HTMLDivElement>(null);
  const byLine = new Map<number, string[]>();
  const add = (line: number, detail: string) => byLine.set(line, [...(byLine.get(line) ?? []), detail]);
  if (located.mistake) add(located.mistake.line, located.mistake.detail);
  else for (const mistake of mistakes) add(lineOf(located, mistake.pointer), mistake.detail);
  const lines = text.split("\n").length;

  useEffect(() => {
    const element = area.current;
    if (!element || !jump) return;
    const start = text.split("\n").slice(0, jump.line - 1).join("\n").length + (jump.line > 1 ? 1 : 0);
    const end = text.indexOf("\n", start);
    element.focus();
    element.setSelectionRange(start, end < 0 ? text.length : end);
    element.scrollTop = Math.max(0, (jump.line - 4) * lineHeight);
  }, [jump]);

  const onKeyDown = (event: KeyboardEvent) => {
    // Enter keeps the indent. Tab is left to move on: the page is to be reached by keyboard.
    if (event.key !== "Enter" || event.isComposing) return;
    const element = area.current;
    if (!element) return;
    const before = text.slice(text.lastIndexOf("\n", element.selectionStart - 1) + 1, element.selectionStart);
    const indent = /^\s*/.exec(before)?.[0] ?? "";
    if (indent === "" && !/[{[]\s*$/.test(before)) return;
    event.preventDefault();
    const deeper = /[{[]\s*$/.test(before) ? `${indent}  ` : indent;
    element.setRangeText(`\n${deeper}`, element.selectionStart, element.selectionEnd, "end");
    onChange(element.value);
  };

  return (
    <div class="editor">
      <div class="editor-scroll">
        <div class="editor-gutter" ref={gutter} aria-hidden="true">
          <div>
            {Array.from({ length: lines }, (_, k) => <span key={k} class={byLine.has(k + 1) ? "wrong" : ""}>{k + 1}</span>)}
          </div>
        </div>
        <textarea ref={area} value={text} spellcheck={false} autocomplete="off" wrap="off" aria-label="Spec as JSON" aria-invalid={byLine.size > 0} aria-describedby="editor-mistakes"
          onInput={(event) => onChange(event.currentTarget.value)} onKeyDown={onKeyDown}
          onScroll={(event) => {
            if (gutter.current) gutter.current.scrollTop = event.currentTarget.scrollTop;
          }} />
      </div>
      <ul class="editor-mistakes" id="editor-mistakes">
        {[...byLine].sort(([a], [b]) => a - b).map(([line, details]) => details.map((detail) => <li key={`${line} ${detail}`}><strong>Line {line}</strong> {detail}</li>))}
      </ul>
    </div>
  );
}
