// Where in a JSON text each value stands, so that mistakes can be shown at their lines.

export interface Located {
  /** Line (from 1) of each value, by JSON pointer: of its key where it has one. */
  lines: ReadonlyMap<string, number>;
  /** What is wrong with the text as JSON; null where nothing is. */
  mistake: { line: number; detail: string } | null;
}

export function locate(text: string): Located {
  const lines = new Map<string, number>();
  let at = 0;
  let line = 1;

  class Wrong extends Error {}
  const fail = (detail: string): never => {
    throw new Wrong(detail);
  };
  const skip = () => {
    for (;;) {
      const character = text[at];
      if (character === "\n") line += 1;
      else if (character !== " " && character !== "\t" && character !== "\r") return;
      at += 1;
    }
  };
  const string = (): string => {
    const begin = at;
    if (text[at] !== '"') fail(`expected a string in quotes before ${shown()}`);
    at += 1;
    while (text[at] !== '"') {
      if (at >= text.length || text[at] === "\n") fail("a string without its closing quote");
      at += text[at] === "\\" ? 2 : 1;
    }
    at += 1;
    try {
      return JSON.parse(text.slice(begin, at)) as string;
    } catch {
      return fail(`a string that is none: ${text.slice(begin, at)}`);
    }
  };
  const shown = () => (at >= text.length ? "the end" : `“${(/^\S{1,12}/.exec(text.slice(at)) ?? [""])[0]}”`);
  const value = (pointer: string): void => {
    skip();
    if (!lines.has(pointer)) lines.set(pointer, line);
    const first = text[at];
    if (first === "{") {
      at += 1;
      skip();
      const keys = new Set<string>();
      if (text[at] === "}") at += 1;
      else
        for (;;) {
          skip();
          if (text[at] === "}") fail("a comma before }; take it away");
          const keyLine = line;
          const key = string();
          if (keys.has(key)) fail(`${JSON.stringify(key)} is there twice`);
          keys.add(key);
          const inner = `${pointer}/${key.replace(/~/g, "~0").replace(/\//g, "~1")}`;
          lines.set(inner, keyLine);
          skip();
          if (text[at] !== ":") fail(`expected : before ${shown()}`);
          at += 1;
          value(inner);
          skip();
          const next = text[at];
          at += 1;
          if (next === "}") break;
          if (next !== ",") {
            at -= 1;
            fail(`expected , or } before ${shown()}`);
          }
        }
    } else if (first === "[") {
      at += 1;
      skip();
      if (text[at] === "]") at += 1;
      else
        for (let k = 0; ; ++k) {
          skip();
          if (text[at] === "]") fail("a comma before ]; take it away");
          value(`${pointer}/${k}`);
          skip();
          const next = text[at];
          at += 1;
          if (next === "]") break;
          if (next !== ",") {
            at -= 1;
            fail(`expected , or ] before ${shown()}`);
          }
        }
    } else if (first === '"') string();
    else {
      const found = /^(?:-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?|true|false|null)(?![\w.+-])/.exec(text.slice(at, at + 400));
      if (!found) fail(`no JSON value: ${shown()}`);
      else at += found[0].length;
    }
  };
  try {
    value("");
    skip();
    if (at < text.length) fail(`something after the end: ${shown()}`);
    return { lines, mistake: null };
  } catch (error) {
    if (!(error instanceof Wrong)) throw error;
    return { lines, mistake: { line, detail: error.message } };
  }
}

/** The line of a pointer, or of the nearest place around it that the text has. */
export function lineOf({ lines }: Located, pointer: string): number {
  for (let place = pointer; ; place = place.slice(0, place.lastIndexOf("/"))) {
    const line = lines.get(place);
    if (line !== undefined) return line;
    if (place === "") return 1;
  }
}
