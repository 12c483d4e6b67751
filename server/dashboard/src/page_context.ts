// What every view stands on: the source, and whether it answers.
import { createContext } from "preact";
import { useContext, useEffect, useRef, useState } from "preact/hooks";
import { pause } from "./events";
import { Problem } from "./problem";
import type { Source } from "./source";

/** Whether the service answers; a lost connection is one for all views. */
export class Connection {
  private lost = false;
  private needsToken = false;
  private readonly listeners = new Set<() => void>();
  /** Grows each time that it is back, so that views load again. */
  epoch = 0;

  get isLost(): boolean {
    return this.lost;
  }

  get isRefused(): boolean {
    return this.needsToken;
  }

  /** Notes how a request went: null, or what came in place of a document. */
  note(problem: Problem | null): void {
    if (problem !== null && problem.status < 0) return; // the page's own fault says nothing of the service
    const lost = problem?.isLost ?? false;
    const refused = problem?.status === 401;
    if ((this.lost && !lost) || (this.needsToken && !refused)) this.epoch += 1;
    if (this.lost === lost && this.needsToken === refused) return;
    this.lost = lost;
    this.needsToken = refused;
    this.changed();
  }

  reload(): void {
    this.epoch += 1;
    this.changed();
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  private changed(): void {
    for (const listener of this.listeners) listener();
  }
}

export interface PageContext {
  source: Source;
  connection: Connection;
}

export const PageContext = createContext<PageContext | null>(null);

export function usePage(): PageContext {
  const page = useContext(PageContext);
  if (!page) throw new Error("outside the page");
  return page;
}

export function useConnection(): Connection {
  const { connection } = usePage();
  const [, draw] = useState(0);
  useEffect(() => connection.subscribe(() => draw((n) => n + 1)), [connection]);
  return connection;
}

export type Loaded<Document> =
  | { state: "loading"; value: null; problem: null }
  | { state: "ready"; value: Document; problem: null }
  /** What was last seen stays in sight, where there is any. */
  | { state: "failed"; value: Document | null; problem: Problem };

/**
 * Loads a document, again when `key` or `revision` changes or the connection is back. A new `key` is another document
 * and begins with nothing; a new `revision` is the same one, whose last state stays in sight meanwhile.
 */
export function useDocument<Document>(
  key: string,
  load: (signal: AbortSignal) => Promise<Document>,
  revision: string | number = 0,
): Loaded<Document> {
  const connection = useConnection();
  const [loaded, setLoaded] = useState<{ key: string; result: Loaded<Document> }>({ key, result: loading });
  const epoch = connection.epoch;
  const wanted = useRef(revision);
  wanted.current = revision;
  const again = useRef<(() => void) | null>(null);
  useEffect(() => {
    const abort = new AbortController();
    const fetchOnce = async (): Promise<void> => {
      try {
        const value = await load(abort.signal);
        if (abort.signal.aborted) return;
        connection.note(null);
        setLoaded({ key, result: { state: "ready", value, problem: null } });
      } catch (error) {
        if (abort.signal.aborted) return;
        const problem = toProblem(error);
        connection.note(problem);
        if (problem.isBusy) {
          await pause(1000 * Math.min(10, problem.retryAfter ?? 2), abort.signal);
          return abort.signal.aborted ? undefined : fetchOnce();
        }
        setLoaded((before) => {
          const value = before.key === key ? before.result.value : null;
          return { key, result: { state: "failed", value, problem } };
        });
      }
    };
    // A new revision never breaks off a load, or one that takes longer than revisions last would never be seen.
    let isLoading = false;
    const keepUp = async (): Promise<void> => {
      if (isLoading) return;
      isLoading = true;
      let seen: string | number | null = null;
      while (seen !== wanted.current && !abort.signal.aborted) {
        seen = wanted.current;
        await fetchOnce();
      }
      isLoading = false;
    };
    again.current = () => void keepUp();
    again.current();
    return () => {
      again.current = null;
      abort.abort();
    };
  }, [key, epoch]);
  useEffect(() => again.current?.(), [revision]);
  return loaded.key === key ? loaded.result : loading;
}

const loading = { state: "loading", value: null, problem: null } as const;

export const toProblem = (error: unknown): Problem =>
  error instanceof Problem ? error : new Problem(-1, "The page failed", error instanceof Error ? error.message : String(error));
