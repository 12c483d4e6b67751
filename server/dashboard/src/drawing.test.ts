import { describe, expect, it } from "vitest";
import { fromOklab, rateColours, textOn, toOklab } from "./colour";
import { logSplits, logTickTexts } from "./log_axis";
import { prose, symbol } from "./names";
import { readProblem } from "./problem";
import { trajectoryCsv } from "./trajectory_csv";

describe("rate colours", () => {
  it("go through their three stops", () => {
    const colour = rateColours(["#c75a00", "#eef0f2", "#0a5a9e"]);
    expect([0, 0.5, 1].map(colour)).toEqual(["#c75a00", "#eef0f2", "#0a5a9e"]);
    expect(colour(-1)).toBe(colour(0));
    expect(colour(2)).toBe(colour(1));
  });
  it("come back from Oklab, and are light or dark", () => {
    for (const hex of ["#000000", "#ffffff", "#0a62a9", "#cf6a0c"]) expect(fromOklab(toOklab(hex))).toBe(hex);
    expect(textOn("#eef0f2")).toBe("#000000");
    expect(textOn("#0a5a9e")).toBe("#ffffff");
  });
});

describe("log axes", () => {
  it("have 1 to 9 times the powers of ten, wherever they begin", () => {
    expect(logSplits(25, 420)).toEqual([30, 40, 50, 60, 70, 80, 90, 100, 200, 300, 400]);
    expect(logSplits(0.0018, 0.0031)).toEqual([0.002, 0.003]);
  });
  it("have powers of ten alone where there are many, and no more than have room", () => {
    expect(logSplits(0.5, 2e6)).toEqual([1, 10, 100, 1e3, 1e4, 1e5, 1e6]);
    expect(logSplits(0.05, 2e8, 5)).toEqual([0.1, 1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8].filter((_, k) => k % 2 === 1));
    expect(logSplits(0.05, 2e14, 1e9).length).toBe(16);
  });
  it("name powers of ten, and 2 and 5 times them where there are too few", () => {
    expect(logTickTexts(logSplits(8, 120)).filter((text) => text !== "")).toEqual(["10", "100"]);
    expect(logTickTexts(logSplits(25, 420)).filter((text) => text !== "")).toEqual(["50", "100", "200"]);
  });
  it("are brief about what is far from 1, so that the ticks of many decades stand side by side", () => {
    const texts = (low: number, high: number) => logTickTexts(logSplits(low, high)).filter((text) => text !== "");
    expect(texts(1, 1e6)).toEqual(["1", "10", "100", "1,000", "10⁴", "10⁵", "10⁶"]);
    expect(texts(1e-4, 1e-2)).toEqual(["10⁻⁴", "0.001", "0.01"]);
  });
});

describe("names", () => {
  it("are the paper's where it has one", () => {
    expect(["plant.f2", "initial_state.q2_dot", "controller.contraction.eta1", "sensor.bias.q1", "controller.swing.period"].map(symbol)).toEqual(["f₂", "q̇₂(0)", "η₁", "q₁ bias", "swing period"]);
  });
});

describe("what the schema says", () => {
  it("is printed with the paper's symbols, and powers that are raised", () => {
    expect(prose("At least 5e-4 from pi/2: |sin 2 q2| >= 1e-3, q1_dot <= 2")).toBe("At least 5×10⁻⁴ from π/2: |sin 2 q₂| ≥ 10⁻³, q̇₁ ≤ 2");
    expect(prose("the default with `stop`")).toBe("the default with “stop”");
  });
});

describe("trajectories as CSV", () => {
  it("have a header and every digit", () => {
    expect(trajectoryCsv({ t: [0, 0.05], q1: [1, 0.9999999999999], phase: ["align", "drift"] })).toBe("t,q1,phase\n0,1,align\n0.05,0.9999999999999,drift\n");
  });
});

describe("problems", () => {
  it("carry the mistakes of a spec", async () => {
    const response = new Response(JSON.stringify({ title: "Bad spec", detail: "2 mistakes", errors: [{ pointer: "/plant/m1", detail: "no" }, { detail: "whole" }, 7] }), { status: 422, headers: { "Retry-After": "3" } });
    const problem = await readProblem(response);
    expect(problem).toMatchObject({ status: 422, title: "Bad spec", retryAfter: 3, mistakes: [{ pointer: "/plant/m1", detail: "no" }, { pointer: "", detail: "whole" }] });
    expect(problem.isLost).toBe(false);
  });
  it("are told in plain words where they have HTTP's", async () => {
    const response = new Response(JSON.stringify({ title: "Not Found", detail: "there is no trial 7" }), { status: 404 });
    expect(await readProblem(response)).toMatchObject({ status: 404, title: "That is not here", detail: "there is no trial 7" });
  });
  it("are told by their status where they have no words", async () => {
    expect((await readProblem(new Response("<html>", { status: 502, statusText: "Bad Gateway" }))).title).toBe("Bad Gateway");
  });
});
