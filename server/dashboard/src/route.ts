// Views are named by the URL's fragment, so that a link leads a colleague to the same picture.
import { useEffect, useState } from "preact/hooks";

export type Tab = "overview" | "why" | "trials";

export type Route =
  | { view: "studies" }
  | { view: "new"; from: string | null }
  | { view: "study"; id: string; tab: Tab; query: Readonly<Record<string, string>> }
  | { view: "trial"; id: string; index: number; t: number | null }
  | { view: "compare"; a: string | null; b: string | null }
  | { view: "unknown"; path: string };

/** @param fragment  with or without the # */
export function parseRoute(fragment: string): Route {
  const [path = "", search = ""] = fragment.replace(/^#/, "").split("?", 2);
  const query = Object.fromEntries(new URLSearchParams(search));
  const parts = path.split("/").filter((part) => part !== "").map(decode);
  const [first, id, third, fourth] = parts;
  if (first === undefined) return { view: "studies" };
  if (first === "new" && parts.length === 1) return { view: "new", from: query.from ?? null };
  if (first === "compare" && parts.length === 1) return { view: "compare", a: query.a ?? null, b: query.b ?? null };
  if (first === "studies" && id === undefined) return { view: "studies" };
  if (first === "studies" && id !== undefined) {
    if (third === undefined) return { view: "study", id, tab: "overview", query };
    if ((third === "why" || third === "trials") && fourth === undefined) return { view: "study", id, tab: third, query };
    if (third === "trials" && parts.length === 4 && /^\d{1,15}$/.test(fourth ?? "")) {
      const t = query.t === undefined ? NaN : Number(query.t);
      return { view: "trial", id, index: Number(fourth), t: Number.isFinite(t) ? t : null };
    }
  }
  return { view: "unknown", path };
}

function decode(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

/** The fragment of a route, with the #. */
export function toFragment(route: Exclude<Route, { view: "unknown" }>): string {
  const withQuery = (path: string, query: Readonly<Record<string, string | null>>) => {
    const search = new URLSearchParams();
    for (const [key, value] of Object.entries(query)) if (value !== null) search.set(key, value);
    const text = search.toString();
    return `#${path}${text ? `?${text}` : ""}`;
  };
  switch (route.view) {
    case "studies":
      return "#/";
    case "new":
      return withQuery("/new", { from: route.from });
    case "compare":
      return withQuery("/compare", { a: route.a, b: route.b });
    case "study":
      return withQuery(`/studies/${encodeURIComponent(route.id)}${route.tab === "overview" ? "" : `/${route.tab}`}`, route.query);
    case "trial":
      return withQuery(`/studies/${encodeURIComponent(route.id)}/trials/${route.index}`, { t: route.t === null ? null : String(route.t) });
  }
}

export const studyLink = (id: string, tab: Tab = "overview") => toFragment({ view: "study", id, tab, query: {} });
export const trialLink = (id: string, index: number) => toFragment({ view: "trial", id, index, t: null });

export function go(route: Exclude<Route, { view: "unknown" }>): void {
  location.hash = toFragment(route);
}

/** Changes the URL without a new entry in the history: for what a reader sets within a view. */
export function replaceRoute(route: Exclude<Route, { view: "unknown" }>): void {
  const fragment = toFragment(route);
  if (fragment === location.hash) return;
  history.replaceState(null, "", fragment);
  dispatchEvent(new HashChangeEvent("hashchange"));
}

/** The fragment as it is now. */
export function useRoute(): Route {
  const [fragment, setFragment] = useState(location.hash);
  useEffect(() => {
    const update = () => setFragment(location.hash);
    addEventListener("hashchange", update);
    update();
    return () => removeEventListener("hashchange", update);
  }, []);
  return parseRoute(fragment);
}
