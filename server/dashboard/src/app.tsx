import { useEffect, useMemo, useState } from "preact/hooks";
import { Connection, PageContext, useConnection, usePage } from "./page_context";
import { Empty, RobotGlyph } from "./parts";
import { pause } from "./events";
import { studyLink, useRoute } from "./route";
import type { Route } from "./route";
import { ServiceSource, type Source } from "./source";
import { type ThemeChoice, chooseTheme, useTheme } from "./theme";
import { CompareView } from "./views/compare";
import { NewStudyView } from "./views/new_study";
import { StudiesView } from "./views/studies";
import { StudyPage } from "./views/study";
import { TrialPage } from "./views/trial";

export function App({ source }: { source: Source }) {
  const context = useMemo(() => ({ source, connection: new Connection() }), [source]);
  return (
    <PageContext.Provider value={context}>
      <Page />
    </PageContext.Provider>
  );
}

function Page() {
  const { source } = usePage();
  const asked = useRoute();
  const route = within(asked, source);
  const place = placeOf(route);
  useEffect(() => {
    scrollTo(0, 0);
  }, [place]);
  return (
    <>
      <a class="skip" href="#main" onClick={(event) => {
        event.preventDefault();
        document.getElementById("main")?.focus();
      }}>Skip to the content</a>
      <header class="top">
        <div class="top-inner">
          <a class="brand" href={source.report ? studyLink(source.report.study.summary.study.id) : "#/"}>
            <RobotGlyph /> <span>steerstat</span>
          </a>
          {source.report ? (
            <span class="top-file" title="The result file that this report was made from">{source.report.file}</span>
          ) : (
            <nav class="top-links" aria-label="Main">
              <a href="#/" aria-current={route.view === "studies" ? "page" : undefined}>Studies</a>
              <a href="#/compare" aria-current={route.view === "compare" ? "page" : undefined}>Compare</a>
              <a href="#/new" class="button small" aria-current={route.view === "new" ? "page" : undefined}>New study</a>
            </nav>
          )}
          <ThemeSwitch />
        </div>
      </header>
      <ConnectionBar />
      <main id="main" tabIndex={-1}>{view(route)}</main>
    </>
  );
}

/** A report has one study: it stands where the service has its list. */
function within(route: Route, source: Source): Route {
  if (!source.report) return route;
  const id = source.report.study.summary.study.id;
  if (route.view === "study" || route.view === "trial") return { ...route, id };
  return { view: "study", id, tab: "overview", query: {} };
}

const placeOf = (route: Route) => JSON.stringify([route.view, "id" in route ? route.id : "", "tab" in route ? route.tab : "", "index" in route ? route.index : ""]);

function view(route: Route) {
  switch (route.view) {
    case "studies":
      return <StudiesView />;
    case "new":
      return <NewStudyView key={route.from ?? ""} from={route.from} />;
    case "study":
      return <StudyPage key={route.id} id={route.id} tab={route.tab} query={route.query} />;
    case "trial":
      return <TrialPage key={`${route.id}/${route.index}`} id={route.id} index={route.index} start={route.t} />;
    case "compare":
      return <CompareView a={route.a} b={route.b} />;
    case "unknown":
      return (
        <Empty title="There is no such view" isWhole>
          <p><a href="#/">All studies</a></p>
        </Empty>
      );
  }
}

function ThemeSwitch() {
  const { choice } = useTheme();
  const next: Record<ThemeChoice, ThemeChoice> = { system: "light", light: "dark", dark: "system" };
  const names: Record<ThemeChoice, string> = { system: "as the system", light: "light", dark: "dark" };
  return (
    <button type="button" class="theme" aria-label={`Theme: ${names[choice]}. Change it`} title={`Theme: ${names[choice]}`} onClick={() => chooseTheme(next[choice])}>
      <svg viewBox="0 0 20 20" width="18" height="18" aria-hidden="true">
        {choice === "light" && <path d="M10 2v2M10 16v2M2 10h2M16 10h2M4.3 4.3l1.5 1.5M14.2 14.2l1.5 1.5M4.3 15.7l1.5-1.5M14.2 5.8l1.5-1.5" stroke="currentColor" stroke-width="1.6" stroke-linecap="round" />}
        {choice === "light" && <circle cx="10" cy="10" r="3.6" fill="currentColor" />}
        {choice === "dark" && <path d="M16 12.4A6.6 6.6 0 0 1 7.6 4a6.6 6.6 0 1 0 8.4 8.4Z" fill="currentColor" />}
        {choice === "system" && <circle cx="10" cy="10" r="6.6" fill="none" stroke="currentColor" stroke-width="1.6" />}
        {choice === "system" && <path d="M10 3.4a6.6 6.6 0 0 1 0 13.2Z" fill="currentColor" />}
      </svg>
    </button>
  );
}

/** Says that the service is gone, and tries until it is back; asks for a token where the service wants one. */
function ConnectionBar() {
  const { source } = usePage();
  const connection = useConnection();
  const isLost = connection.isLost;
  useEffect(() => {
    if (!isLost) return;
    const abort = new AbortController();
    void (async () => {
      for (let attempt = 0; !abort.signal.aborted; ++attempt) {
        await pause(Math.min(4000, 500 * 1.5 ** attempt), abort.signal);
        if (abort.signal.aborted) return;
        try {
          const response = await fetch("healthz", { signal: abort.signal, cache: "no-store" });
          if (response.ok) connection.note(null);
        } catch {
          // still gone
        }
      }
    })();
    return () => abort.abort();
  }, [isLost, connection]);
  if (connection.isRefused && source instanceof ServiceSource) return <TokenForm source={source} connection={connection} />;
  return (
    <div class="connection" role="status" data-lost={isLost}>
      {isLost && <p><span class="pulse" aria-hidden="true" /> No connection to the service. What you see is as it was last; the page goes on by itself as soon as it answers.</p>}
    </div>
  );
}

function TokenForm({ source, connection }: { source: ServiceSource; connection: Connection }) {
  const [token, setToken] = useState("");
  return (
    <form class="token" onSubmit={(event) => {
      event.preventDefault();
      source.setToken(token.trim());
      connection.reload();
    }}>
      <label>
        {source.hasToken ? "The service does not know this token. Another:" : "This service asks for a token (serve --token-file):"}
        <input type="password" value={token} onInput={(event) => setToken(event.currentTarget.value)} autocomplete="off" />
      </label>
      <button type="submit" class="button">Go on</button>
    </form>
  );
}
