// Server-Sent Events over fetch: EventSource can send no token, and gives up for good when a restarting service
// answers with an error once.

export interface ServerEvent {
  id: string | null;
  event: string;
  data: string;
}

/** Takes a stream's text piece by piece, wherever it was cut, and gives the events that are complete. */
export class EventParser {
  private rest = "";
  private id: string | null = null;
  private event = "";
  private data: string[] = [];
  /** Milliseconds to wait before a new connection, where the stream says so. */
  retry: number | null = null;

  push(text: string): ServerEvent[] {
    this.rest += text;
    const events: ServerEvent[] = [];
    for (;;) {
      const end = this.rest.search(/[\r\n]/);
      if (end < 0 || (this.rest[end] === "\r" && end === this.rest.length - 1)) return events; // \r\n may be cut
      const line = this.rest.slice(0, end);
      this.rest = this.rest.slice(end + (this.rest.startsWith("\r\n", end) ? 2 : 1));
      const event = this.take(line);
      if (event) events.push(event);
    }
  }

  private take(line: string): ServerEvent | null {
    if (line === "") {
      const event = this.data.length > 0 ? { id: this.id, event: this.event || "message", data: this.data.join("\n") } : null;
      this.event = "";
      this.data = [];
      return event;
    }
    const colon = line.indexOf(":");
    if (colon === 0) return null; // a comment, sent to keep the connection
    const field = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? "" : line.slice(colon + 1).replace(/^ /, "");
    if (field === "event") this.event = value;
    else if (field === "data") this.data.push(value);
    else if (field === "id") this.id = value;
    else if (field === "retry" && /^\d+$/.test(value)) this.retry = Number(value);
    return null;
  }
}

/** How long to wait before trial `attempt` (from 0) to connect again [ms]: doubling, up to 8 s. */
export const backoff = (attempt: number) => Math.min(8000, 500 * 2 ** attempt);

export interface Follow {
  onEvent: (event: ServerEvent) => void;
  /** Of every attempt: whether the stream is open. */
  onOpen: (isOpen: boolean) => void;
  /** Whether to go on after this event, or after an answer that is no stream (its status). */
  goesOn: (last: ServerEvent | number) => boolean;
}

/** Follows a stream of events, connecting again with Last-Event-ID, until it is done or aborted. */
export async function follow(
  open: (headers: Record<string, string>, signal: AbortSignal) => Promise<Response>,
  { onEvent, onOpen, goesOn }: Follow,
  signal: AbortSignal,
): Promise<void> {
  let lastId: string | null = null;
  for (let attempt = 0; !signal.aborted; ++attempt) {
    let retry: number | null = null;
    try {
      const headers: Record<string, string> = { Accept: "text/event-stream" };
      if (lastId !== null) headers["Last-Event-ID"] = lastId;
      const response = await open(headers, signal);
      if (!response.ok || !response.body) {
        if (!goesOn(response.status)) return;
        const seconds = Number(response.headers.get("Retry-After"));
        if (seconds > 0) retry = 1000 * seconds;
      } else {
        onOpen(true);
        const parser = new EventParser();
        const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
        for (;;) {
          const { done, value } = await reader.read();
          if (done) break;
          for (const event of parser.push(value)) {
            attempt = 0;
            if (event.id !== null) lastId = event.id;
            onEvent(event);
            if (!goesOn(event)) {
              void reader.cancel();
              return;
            }
          }
        }
        retry = parser.retry;
      }
    } catch {
      // No connection, or a broken one: the same as an end.
    }
    if (signal.aborted) return;
    onOpen(false);
    await pause(retry ?? backoff(attempt), signal);
  }
}

/** Waits, at most until aborted. */
export function pause(milliseconds: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const end = () => {
      clearTimeout(timer);
      signal.removeEventListener("abort", end);
      resolve();
    };
    const timer = setTimeout(end, milliseconds);
    signal.addEventListener("abort", end);
  });
}
