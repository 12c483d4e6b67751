import { describe, expect, it } from "vitest";
import { pinched, within } from "./touch_zoom";

const whole = { min: 0, max: 100 };

describe("Two fingers on a chart", () => {
  it("keep the values that they were put on", () => {
    const { min, max } = pinched([40, 60], [0.25, 0.75], whole);
    expect(min + 0.25 * (max - min)).toBeCloseTo(40, 10);
    expect(min + 0.75 * (max - min)).toBeCloseTo(60, 10);
  });
  it("show all again when they come together, or cross", () => {
    expect(pinched([40, 60], [0.45, 0.55], whole)).toEqual(whole);
    expect(pinched([40, 60], [0.5, 0.5], whole)).toEqual(whole);
    expect(pinched([40, 60], [0.6, 0.5], whole)).toEqual(whole);
  });
  it("do not zoom beyond a thousandth of the whole", () => {
    const { min, max } = pinched([50, 50.001], [0, 1], whole);
    expect(max - min).toBeCloseTo(0.1, 10);
  });
});

describe("One finger on a zoomed chart", () => {
  it("stops at the ends of the data, as wide as before", () => {
    expect(within({ min: -5, max: 15 }, whole)).toEqual({ min: 0, max: 20 });
    expect(within({ min: 90, max: 110 }, whole)).toEqual({ min: 80, max: 100 });
    expect(within({ min: 30, max: 50 }, whole)).toEqual({ min: 30, max: 50 });
  });
});
