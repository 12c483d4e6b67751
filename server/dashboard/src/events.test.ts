import { describe, expect, it } from "vitest";
import { EventParser, type ServerEvent, backoff, follow } from "./events";

const text = ": hello\n\nid: 1\nevent: progress\ndata: {\"a\":1}\n\nid: 2\r\ndata: one\r\ndata: two\r\n\r\nevent: done\ndata:\n\nid: 9\n\n";
const events: ServerEvent[] = [
  { id: "1", event: "progress", data: '{"a":1}' },
  { id: "2", event: "message", data: "one\ntwo" },
  { id: "2", event: "done", data: "" },
];

describe("EventParser", () => {
  it("reads the same events wherever the stream is cut", () => {
    for (let size = 1; size <= text.length; ++size) {
      const parser = new EventParser();
      const got: ServerEvent[] = [];
      for (let at = 0; at < text.length; at += size) got.push(...parser.push(text.slice(at, at + size)));
      expect(got, `pieces of ${size}`).toEqual(events);
    }
  });

  it("keeps an event back until its empty line", () => {
    const parser = new EventParser();
    expect(parser.push("data: x\n")).toEqual([]);
    expect(parser.push("\n")).toHaveLength(1);
  });

  it("knows how long to wait", () => {
    const parser = new EventParser();
    parser.push("retry: 250\nretry: soon\n");
    expect(parser.retry).toBe(250);
  });
});

/** A stream that ends after these pieces. */
const stream = (...pieces: string[]) => new Response(new ReadableStream({
  start(controller) {
    for (const piece of pieces) controller.enqueue(new TextEncoder().encode(piece));
    controller.close();
  },
}));

describe("follow", () => {
  it("goes on after a break with the id seen last, and ends with the last event", async () => {
    const asked: (string | undefined)[] = [];
    const got: string[] = [];
    const opened: boolean[] = [];
    const answers = [
      () => Promise.resolve(stream("retry: 1\nid: 5\nevent: progress\ndata: a\n\n")),
      () => Promise.reject(new TypeError("no connection")),
      () => Promise.resolve(stream("retry: 1\nid: 6\nevent: done\ndata: b\n\nid: 7\nevent: progress\ndata: late\n\n")),
    ];
    await follow(
      (headers) => {
        asked.push(headers["Last-Event-ID"]);
        return (answers.shift() ?? (() => Promise.reject(new Error("asked too often"))))();
      },
      { onEvent: (event) => got.push(event.data), onOpen: (isOpen) => opened.push(isOpen), goesOn: (last) => typeof last !== "number" && last.event !== "done" },
      new AbortController().signal,
    );
    expect(asked).toEqual([undefined, "5", "5"]);
    expect(got).toEqual(["a", "b"]);
    expect(opened).toEqual([true, false, false, true]);
  });

  it("ends where the answer is final", async () => {
    let asked = 0;
    await follow(
      () => {
        asked += 1;
        return Promise.resolve(new Response("", { status: 404 }));
      },
      { onEvent: () => undefined, onOpen: () => undefined, goesOn: (last) => typeof last === "number" && last >= 500 },
      new AbortController().signal,
    );
    expect(asked).toBe(1);
  });

  it("ends when aborted while it waits", async () => {
    const abort = new AbortController();
    const end = follow(() => Promise.reject(new TypeError("gone")), { onEvent: () => undefined, onOpen: () => abort.abort(), goesOn: () => true }, abort.signal);
    await end;
    expect(abort.signal.aborted).toBe(true);
  });
});

describe("backoff", () => {
  it("doubles from half a second up to eight", () => {
    expect([0, 1, 2, 3, 4, 5, 50].map(backoff)).toEqual([500, 1000, 2000, 4000, 8000, 8000, 8000]);
  });
});
