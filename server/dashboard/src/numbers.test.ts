import { describe, expect, it } from "vitest";
import { ago, count, duration, number, percent, percentOf, percentRange, quantity } from "./numbers";

describe("number", () => {
  it("keeps the digits asked for, and no zeros after them", () => {
    expect(number(92.3187)).toBe("92.32");
    expect(number(0.5)).toBe("0.5");
    expect(number(300)).toBe("300");
    expect(number(-0.0034567, 3)).toBe("−0.00346");
    expect(number(299999.6)).toBe("300,000");
  });
  it("writes what is very large or small with a power", () => {
    expect(number(3.5e8)).toBe("3.5×10⁸");
    expect(number(1e6)).toBe("1×10⁶");
    expect(number(0.001)).toBe("0.001");
    expect(number(0.00099)).toBe("9.9×10⁻⁴");
  });
  it("says where there is none", () => {
    expect(number(null)).toBe("–");
    expect(number(NaN)).toBe("–");
    expect(number(Infinity)).toBe("∞");
    expect(number(0)).toBe("0");
  });
});

describe("shares", () => {
  it("have the digits that their interval allows", () => {
    expect(percentOf(0.452, 0.4303, 0.4739)).toBe("45.2 %");
    expect(percentOf(0.452, 0.4517, 0.4523)).toBe("45.200 %");
    expect(percentOf(0.5, 0.1, 0.9)).toBe("50 %");
    expect(percentRange(0.4303, 0.4739)).toBe("43.0 to 47.4 %");
    expect(percent(null)).toBe("–");
  });
});

describe("durations and counts", () => {
  it("read as people say them", () => {
    expect(duration(0.4)).toBe("under 1 s");
    expect(duration(59.4)).toBe("59 s");
    expect(duration(200)).toBe("3 min 20 s");
    expect(duration(599)).toBe("9 min 59 s");
    expect(duration(1058)).toBe("18 min");
    expect(duration(3569)).toBe("59 min");
    expect(duration(3570)).toBe("1 h 0 min");
    expect(duration(3900)).toBe("1 h 5 min");
    expect(duration(null)).toBe("–");
    expect(count(1234567)).toBe("1,234,567");
    expect(count(-1000)).toBe("−1,000");
    expect(quantity(2, "kg")).toBe("2 kg");
    expect(quantity(2, "1")).toBe("2");
  });
  it("tell how long ago", () => {
    const now = Date.parse("2026-01-02T00:00:00Z");
    expect(ago("2026-01-01T23:59:30Z", now)).toBe("just now");
    expect(ago("2026-01-01T23:10:00Z", now)).toBe("50 min ago");
    expect(ago("2026-01-01T00:00:00Z", now)).toBe("1 d ago");
    expect(ago("2025-01-01T00:00:00Z", now)).toBe("2025-01-01");
  });
});
