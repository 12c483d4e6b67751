// Studies that change while the page looks on.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { type StudyState, isActive } from "./documents";
import { pause } from "./events";
import { toProblem, useConnection, usePage } from "./page_context";
import type { Problem } from "./problem";

/** Streams at a time: browsers allow six connections to a host, and requests need some. */
const mostStreams = 3;

/**
 * Follows studies' events. Where a stream cannot be had, the caller's own looks must do; `onBreak` says that one broke,
 * so that it looks at once.
 */
export function useEvents(ids: readonly string[], onState: (state: StudyState) => void, onBreak: () => void): void {
  const { source, connection } = usePage();
  const latest = useRef({ onState, onBreak });
  latest.current = { onState, onBreak };
  const followed = ids.slice(0, mostStreams).join(" ");
  useEffect(() => {
    const abort = new AbortController();
    for (const id of followed.split(" ").filter((each) => each !== "")) {
      void source.follow(
        id,
        {
          onEvent: (event) => {
            if (event.event !== "progress" && event.event !== "done") return;
            try {
              latest.current.onState(JSON.parse(event.data) as StudyState);
            } catch {
              // not a state: the next look will tell
            }
          },
          onOpen: (isOpen) => {
            if (isOpen) connection.note(null);
            else if (!connection.isLost) latest.current.onBreak();
          },
        },
        abort.signal,
      );
    }
    return () => abort.abort();
  }, [followed, source, connection]);
}

export interface Studies {
  studies: StudyState[] | null;
  problem: Problem | null;
  hasMore: boolean;
  more: () => void;
  /** Looks again now. */
  refresh: () => void;
}

/** The list of studies, kept up to date: by events where studies run, and by looking again every few seconds. */
export function useStudies(): Studies {
  const { source } = usePage();
  const connection = useConnection();
  const [studies, setStudies] = useState<StudyState[] | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [cursor, setCursor] = useState<string | null>(null);
  const [look, setLook] = useState(0);
  const [pages, setPages] = useState(1);
  const active = useMemo(() => (studies ?? []).filter(isActive).map((state) => state.id), [studies]);
  const isBusy = active.length > 0;

  useEffect(() => {
    const abort = new AbortController();
    void (async () => {
      while (!abort.signal.aborted) {
        try {
          let next: string | null = null;
          const all: StudyState[] = [];
          for (let page = 0; page < pages; ++page) {
            const got = await source.studies(next, abort.signal);
            all.push(...got.studies);
            next = got.next ?? null;
            if (next === null) break;
          }
          if (abort.signal.aborted) return;
          connection.note(null);
          setStudies(all);
          setCursor(next);
          setProblem(null);
        } catch (error) {
          if (abort.signal.aborted) return;
          const why = toProblem(error);
          connection.note(why);
          setProblem(why);
          if (why.isLost || why.status === 401) return; // back with the connection
        }
        await pause(document.hidden ? 15000 : isBusy ? 2500 : 8000, abort.signal);
      }
    })();
    return () => abort.abort();
  }, [source, connection.epoch, look, pages, isBusy]);

  useEvents(active, (state) => {
    setStudies((before) => before?.map((each) => (each.id === state.id ? { ...each, ...state } : each)) ?? null);
  }, () => setLook((n) => n + 1));

  return {
    studies,
    problem,
    hasMore: cursor !== null,
    more: () => setPages((n) => n + 1),
    refresh: () => setLook((n) => n + 1),
  };
}

/** The state of one study, followed while it is active. null of a report and until it is known. */
export function useStudyState(id: string): { state: StudyState | null; problem: Problem | null; refresh: () => void } {
  const { source } = usePage();
  const connection = useConnection();
  const [state, setState] = useState<StudyState | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [look, setLook] = useState(0);
  const active = state !== null && isActive(state);
  useEffect(() => {
    if (source.report) return;
    const abort = new AbortController();
    void (async () => {
      for (;;) {
        try {
          const got = await source.state(id, abort.signal);
          if (abort.signal.aborted) return;
          connection.note(null);
          setState(got);
          setProblem(null);
          if (!isActive(got)) return;
        } catch (error) {
          if (abort.signal.aborted) return;
          const why = toProblem(error);
          connection.note(why);
          setProblem(why);
          return;
        }
        await pause(5000, abort.signal); // for what the stream misses
        if (abort.signal.aborted) return;
      }
    })();
    return () => abort.abort();
  }, [source, id, connection.epoch, look]);
  useEvents(active ? [id] : [], (next) => setState((before) => ({ ...before, ...next })), () => setLook((n) => n + 1));
  return { state, problem, refresh: () => setLook((n) => n + 1) };
}

/** The time, every so often, for "3 min ago". */
export function useNow(milliseconds: number): number {
  const [now, setNow] = useState(Date.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(Date.now()), milliseconds);
    return () => clearInterval(timer);
  }, [milliseconds]);
  return now;
}
