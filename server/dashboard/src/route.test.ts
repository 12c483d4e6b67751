import { describe, expect, it } from "vitest";
import { parseRoute, studyLink, toFragment, trialLink } from "./route";

describe("routes", () => {
  it("name every view, there and back", () => {
    const fragments = ["#/", "#/new", "#/new?from=0123456789abcdef", "#/compare", "#/compare?a=1&b=2", "#/studies/0123456789abcdef", "#/studies/0123456789abcdef/why?x=plant.f2&y=plant.m1", "#/studies/0123456789abcdef/trials?status=timeout", "#/studies/0123456789abcdef/trials/17", "#/studies/0123456789abcdef/trials/17?t=12.5"];
    for (const fragment of fragments) {
      const route = parseRoute(fragment);
      if (route.view === "unknown") throw new Error(`${fragment} is not known`);
      expect(toFragment(route)).toBe(fragment);
    }
  });

  it("lead to a trial by its number", () => {
    expect(parseRoute(trialLink("ab", 17))).toEqual({ view: "trial", id: "ab", index: 17, t: null });
    expect(parseRoute(studyLink("ab", "why"))).toMatchObject({ view: "study", id: "ab", tab: "why" });
  });

  it("are unknown where a trial has no number, or too much follows", () => {
    for (const fragment of ["#/studies/a/trials/seventeen", "#/studies/a/trials/-1", "#/studies/a/trials/1.5", "#/studies/a/trials/1/2", "#/studies/a/whence", "#/elsewhere", "#/new/er"]) {
      expect(parseRoute(fragment).view, fragment).toBe("unknown");
    }
  });

  it("begin with the studies, and bear a broken escape", () => {
    expect(parseRoute("")).toEqual({ view: "studies" });
    expect(parseRoute("#/studies/%E0%A4%A")).toMatchObject({ view: "study", id: "%E0%A4%A" });
  });
});
