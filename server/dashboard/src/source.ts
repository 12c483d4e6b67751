// Where the page's documents come from: the service that served it, or the report that it stands in.
import type { ComparisonView, MapView, ReportView, StudyState, StudyView, TrialView } from "./documents";
import { type Follow, follow } from "./events";
import type { Trajectory } from "./trajectory_csv";
import { Problem, lostConnection, readProblem } from "./problem";

export interface StudyPage {
  studies: StudyState[];
  next: string | null;
}

export interface Source {
  /** The report's study; null of a service, which may have many. */
  readonly report: ReportView | null;
  studies(cursor: string | null, signal?: AbortSignal): Promise<StudyPage>;
  state(id: string, signal?: AbortSignal): Promise<StudyState>;
  study(id: string, signal?: AbortSignal): Promise<StudyView>;
  map(id: string, x: string, y: string, signal?: AbortSignal): Promise<MapView>;
  trial(id: string, index: number, signal?: AbortSignal): Promise<TrialView>;
  /** Whether trial() has it. */
  has(index: number): boolean;
  comparison(a: string, b: string, signal?: AbortSignal): Promise<ComparisonView>;
  spec(id: string, signal?: AbortSignal): Promise<unknown>;
  submit(spec: string): Promise<StudyState>;
  remove(id: string): Promise<void>;
  follow(id: string, follower: Pick<Follow, "onEvent" | "onOpen">, signal: AbortSignal): Promise<void>;
}

const tokenKey = "steerstat-token";

export class ServiceSource implements Source {
  readonly report = null;

  setToken(token: string): void {
    sessionStorage.setItem(tokenKey, token);
  }

  studies(cursor: string | null, signal?: AbortSignal): Promise<StudyPage> {
    return this.json(`v1/studies?limit=50${cursor === null ? "" : `&cursor=${encodeURIComponent(cursor)}`}`, signal);
  }

  state(id: string, signal?: AbortSignal): Promise<StudyState> {
    return this.json(`v1/studies/${encodeURIComponent(id)}`, signal);
  }

  study(id: string, signal?: AbortSignal): Promise<StudyView> {
    return this.json(`v1/studies/${encodeURIComponent(id)}/view`, signal);
  }

  map(id: string, x: string, y: string, signal?: AbortSignal): Promise<MapView> {
    const query = new URLSearchParams({ x, y });
    return this.json(`v1/studies/${encodeURIComponent(id)}/view/map?${query}`, signal);
  }

  trial(id: string, index: number, signal?: AbortSignal): Promise<TrialView> {
    return this.json(`v1/studies/${encodeURIComponent(id)}/trials/${index}/view`, signal);
  }

  has(): boolean {
    return true;
  }

  comparison(a: string, b: string, signal?: AbortSignal): Promise<ComparisonView> {
    return this.json("v1/comparisons/view", signal, { method: "POST", body: JSON.stringify({ a, b }) });
  }

  spec(id: string, signal?: AbortSignal): Promise<unknown> {
    return this.json(`v1/studies/${encodeURIComponent(id)}/spec`, signal);
  }

  submit(spec: string): Promise<StudyState> {
    return this.json("v1/studies", undefined, { method: "POST", body: spec });
  }

  async remove(id: string): Promise<void> {
    await this.request(`v1/studies/${encodeURIComponent(id)}`, { method: "DELETE" });
  }

  follow(id: string, follower: Pick<Follow, "onEvent" | "onOpen">, signal: AbortSignal): Promise<void> {
    return follow(
      (headers, inner) => fetch(`v1/studies/${encodeURIComponent(id)}/events`, { headers: this.headers(headers), signal: inner, cache: "no-store" }),
      {
        ...follower,
        // 204, 404 and 410: there is nothing to follow any more.
        goesOn: (last) => (typeof last === "number" ? last >= 500 || last === 429 : last.event !== "done"),
      },
      signal,
    );
  }

  private async json<Document>(path: string, signal?: AbortSignal, init: RequestInit = {}): Promise<Document> {
    const response = await this.request(path, signal ? { ...init, signal } : init);
    try {
      return (await response.json()) as Document;
    } catch (error) {
      if (error instanceof DOMException) throw error; // aborted
      throw lostConnection(); // cut short
    }
  }

  private async request(path: string, init: RequestInit): Promise<Response> {
    let response: Response;
    try {
      const headers: Record<string, string> = { Accept: "application/json" };
      if (typeof init.body === "string") headers["Content-Type"] = "application/json";
      response = await fetch(path, { ...init, headers: this.headers(headers) });
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") throw error;
      throw lostConnection();
    }
    if (!response.ok) throw await readProblem(response);
    return response;
  }

  private headers(headers: Record<string, string>): Record<string, string> {
    const token = sessionStorage.getItem(tokenKey);
    return token === null ? headers : { ...headers, Authorization: `Bearer ${token}` };
  }

  /** Every point of a trial's course, recomputed. */
  async trajectory(id: string, index: number): Promise<Trajectory> {
    return (await this.json<{ trajectory: Trajectory }>(`v1/studies/${encodeURIComponent(id)}/trials/${index}/trajectory`)).trajectory;
  }

  /** The result file, fetched with the token where there is one, so that a plain link would not do. */
  async resultFile(id: string): Promise<Blob> {
    return (await this.request(`v1/studies/${encodeURIComponent(id)}/results.h5`, {})).blob();
  }

  get hasToken(): boolean {
    return sessionStorage.getItem(tokenKey) !== null;
  }
}

export class ReportSource implements Source {
  private readonly trials: ReadonlyMap<number, TrialView>;

  constructor(readonly report: ReportView) {
    this.trials = new Map(report.trials.map((trial) => [trial.index, trial]));
  }

  has(index: number): boolean {
    return this.trials.has(index);
  }

  async study(): Promise<StudyView> {
    return this.report.study;
  }

  async map(_id: string, x: string, y: string): Promise<MapView> {
    const found = this.report.study.maps.find((map) => map.x.input === x && map.y.input === y);
    if (found) return found;
    const turned = this.report.study.maps.find((map) => map.x.input === y && map.y.input === x);
    if (turned) return transpose(turned);
    throw new Problem(404, "The report has no map of these two inputs", "It holds those of the inputs that matter most; the service has all.");
  }

  async trial(_id: string, index: number): Promise<TrialView> {
    const trial = this.trials.get(index);
    if (trial) return trial;
    const command = `steerstat replay ${this.report.file} --trial ${index}`;
    throw new Problem(404, `Trial ${index} is not in this report`, `It holds some of the trials that failed and a few that did not. Computed anew: ${command}`);
  }

  studies = () => this.none();
  state = () => this.none();
  comparison = () => this.none();
  spec = () => this.none();
  submit = () => this.none();
  remove = () => this.none();
  follow = () => this.none();

  private async none(): Promise<never> {
    throw new Problem(404, "A report holds one study", "Open it in the service for more.");
  }
}

/** The same map with its axes exchanged. */
export function transpose(map: MapView): MapView {
  const rows = (map.y.levels ?? map.y.edges?.slice(1) ?? []).length;
  const columns = (map.x.levels ?? map.x.edges?.slice(1) ?? []).length;
  const turn = (values: number[]) =>
    Array.from({ length: values.length }, (_, k) => values[(k % rows) * columns + Math.floor(k / rows)] ?? 0);
  return { ...map, x: map.y, y: map.x, trials: turn(map.trials), successes: turn(map.successes) };
}

/** Of the document that the page stands in. */
export function findSource(): Source {
  const embedded = document.getElementById("steerstat-report");
  if (embedded) return new ReportSource(JSON.parse(embedded.textContent ?? "") as ReportView);
  return new ServiceSource();
}
