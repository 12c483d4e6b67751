/** What a bad spec has at one place. */
export interface Mistake {
  /** JSON pointer; empty for the whole. */
  pointer: string;
  detail: string;
}

/** Why a request was refused or got no answer, in words for the reader. */
export class Problem extends Error {
  constructor(
    /** HTTP status; 0 where there was no answer. */
    readonly status: number,
    readonly title: string,
    readonly detail: string,
    readonly mistakes: readonly Mistake[] = [],
    /** Seconds to wait before trying again, where the service says so. */
    readonly retryAfter: number | null = null,
  ) {
    super(detail ? `${title}: ${detail}` : title);
  }

  /** Whether the service has too much to do just now, and wants to be asked again. */
  get isBusy(): boolean {
    return this.status === 503 || this.status === 429;
  }

  /** Whether there was no service to answer. */
  get isLost(): boolean {
    return this.status === 0;
  }
}

export const lostConnection = () =>
  new Problem(0, "No connection to the service", "It does not answer. The page tries again by itself.");

/** What HTTP's own phrases say to a reader. */
const plainWords: Readonly<Record<string, string>> = {
  "Bad Request": "The service does not understand this",
  "Not Found": "That is not here",
  "Unprocessable Content": "That cannot be done",
  "Too Many Requests": "Too much at once",
  "Internal Server Error": "The service has failed",
  "Service Unavailable": "The service has too much to do",
};

/** Reads an RFC 9457 problem from a response that is no success. */
export async function readProblem(response: Response): Promise<Problem> {
  const retry = Number(response.headers.get("Retry-After"));
  const retryAfter = response.headers.has("Retry-After") && Number.isFinite(retry) ? retry : null;
  let body: unknown = null;
  try {
    body = await response.json();
  } catch {
    // Not from the service itself, but from what stands between: the status has to do.
  }
  const of = (key: string) => {
    const value = body !== null && typeof body === "object" ? (body as Record<string, unknown>)[key] : undefined;
    return typeof value === "string" ? value : "";
  };
  const errors = body !== null && typeof body === "object" ? (body as { errors?: unknown }).errors : undefined;
  const mistakes = Array.isArray(errors)
    ? errors.flatMap((error: unknown) => {
        const { pointer, detail } = (error ?? {}) as Partial<Mistake>;
        return typeof detail === "string" ? [{ pointer: typeof pointer === "string" ? pointer : "", detail }] : [];
      })
    : [];
  const title = of("title") || response.statusText || `Status ${response.status}`;
  return new Problem(response.status, plainWords[title] ?? title, of("detail"), mistakes, retryAfter);
}
