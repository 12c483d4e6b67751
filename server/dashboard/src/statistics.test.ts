import { describe, expect, it } from "vitest";
import type { Axis, MapView } from "./documents";
import { transpose } from "./source";
import { binOf, binPlane, coarser, cycleRange, interpolate, lastAtOrBelow, wilson } from "./statistics";

const edges = (values: number[]): Axis => ({ input: "plant.m1", unit: "kg", edges: values, levels: null });
const levels = (values: number[]): Axis => ({ input: "plant.m1", unit: "kg", edges: null, levels: values });

describe("wilson", () => {
  it("gives the interval that the summary gives", () => {
    // 904 of 2,000: the README's study.
    const interval = wilson(904, 2000);
    expect(interval?.low).toBeCloseTo(0.4303, 4);
    expect(interval?.high).toBeCloseTo(0.4739, 4);
  });
  it("reaches 0 and 1 exactly, and has none without trials", () => {
    expect(wilson(0, 10)?.low).toBe(0);
    expect(wilson(10, 10)?.high).toBe(1);
    expect(wilson(0, 0)).toBeNull();
  });
});

describe("bins", () => {
  it("have their lower edge and not their upper one, but for the last", () => {
    const axis = edges([0, 1, 2, 4]);
    expect([-0.001, 0, 0.999, 1, 2, 3.999, 4, 4.001, NaN].map((value) => binOf(axis, value))).toEqual([-1, 0, 0, 1, 2, 2, 2, -1, -1]);
  });
  it("of levels are the nearest", () => {
    expect([0.3, 0.5000001, 0.69].map((value) => binOf(levels([0.3, 0.5, 0.7]), value))).toEqual([0, 1, 2]);
  });
  it("of a plane count every trial once", () => {
    const { trials, successes, outside } = binPlane(edges([0, 1, 2]), levels([10, 20, 30]), [0.5, 1.5, 1.5, 2, 7], [10, 20, 20, 30, 10], [true, false, true, true, true]);
    expect(trials).toEqual([1, 0, 0, 2, 0, 1]);
    expect(successes).toEqual([1, 0, 0, 1, 0, 1]);
    expect(outside).toBe(1);
  });
  it("made coarser keep their ends", () => {
    const all = Array.from({ length: 25 }, (_, k) => k);
    const few = coarser(edges(all), 10).edges ?? [];
    expect(few.length - 1).toBeLessThanOrEqual(10);
    expect([few[0], few[few.length - 1]]).toEqual([0, 24]);
    expect(coarser(levels([1, 2, 3]), 2)).toEqual(levels([1, 2, 3]));
  });
});

describe("transpose", () => {
  it("puts bin (i, j) at (j, i), and twice is nothing", () => {
    const map: MapView = { view: "map", version: 1, study: { id: "0", name: "x" }, x: { ...edges([0, 1, 2, 3]), input: "plant.m1" }, y: { ...levels([5, 6]), input: "plant.m2" }, of: 21, outside: 0, trials: [1, 2, 3, 4, 5, 6], successes: [0, 1, 2, 3, 4, 5] };
    const turned = transpose(map);
    expect(turned.x.input).toBe("plant.m2");
    expect(turned.trials).toEqual([1, 4, 2, 5, 3, 6]);
    expect(transpose(turned)).toEqual(map);
  });
});

describe("curves", () => {
  it("are linear between points, and stop at their ends", () => {
    expect(interpolate([0, 1, 3], [10, 20, 0], 2)).toBe(10);
    expect(interpolate([0, 1, 3], [10, 20, 0], -1)).toBe(10);
    expect(interpolate([0, 1, 3], [10, 20, 0], 9)).toBe(0);
  });
  it("jump where a time stands twice: the later point counts", () => {
    expect(interpolate([0, 1, 1, 2], [0, 0, 5, 5], 1)).toBe(5);
    expect(lastAtOrBelow([0, 1, 1, 2], 1)).toBe(2);
    expect(lastAtOrBelow([1, 2], 0)).toBe(0);
  });
});

describe("bars of cycles", () => {
  it("have room around few numbers, and none below 0", () => {
    expect(cycleRange(7, 7)).toEqual([3.5, 10.5]);
    expect(cycleRange(0, 1)).toEqual([-0.5, 6.5]);
    expect(cycleRange(3, 30)).toEqual([2.5, 30.5]);
  });
});
