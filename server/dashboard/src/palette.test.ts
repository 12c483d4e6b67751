import { describe, expect, it } from "vitest";
import { rateColours, toOklab } from "./colour";
import { type Vision, distance, seenAs, visions } from "./colour_vision";
import style from "./style.css?raw";

/** The colours of a theme, by their names in the style sheet. */
function theme(selector: string): (name: string) => string {
  const from = style.indexOf(`${selector} {`);
  const block = style.slice(from, style.indexOf("}", from));
  return (name) => {
    const colour = new RegExp(`--${name}: (#[0-9a-f]{6});`).exec(block)?.[1];
    if (colour === undefined) throw new Error(`${selector} has no ${name}`);
    return colour;
  };
}

const themes = { light: theme(":root"), dark: theme(':root[data-theme="dark"]') };
const pairsOf = (names: readonly string[]) => names.flatMap((a, k) => names.slice(k + 1).map((b) => [a, b] as const));
const coloured = visions.filter((vision) => vision !== "achromatopsia");

function expectApart(colour: (name: string) => string, pairs: readonly (readonly [string, string])[], as: readonly Vision[], least: number): void {
  for (const vision of as) {
    for (const [a, b] of pairs) expect(distance(colour(a), colour(b), vision), `${a} and ${b}, ${vision}`).toBeGreaterThan(least);
  }
}

// A difference of 0.02 in Oklab is just noticed between large patches side by side [Ottosson 2020]. Marks are small and
// far apart in a chart: five times that where colour is the first thing that tells them apart, and twice and a half
// where letters, dashes and words beside them do too.
const clear = 0.1;
const enough = 0.05;

describe.each(Object.entries(themes))("the %s palette", (_name, colour) => {
  const statuses = ["converged", "timeout", "singular", "diverged", "integrator-failed"];
  const phases = ["phase-align", "phase-drift", "phase-contraction", "phase-swing"];

  it("has outcomes that every kind of colour vision tells apart", () => {
    expectApart(colour, pairsOf(statuses), coloured, clear);
  });
  it("has what converged apart from what did not without any colour", () => {
    expectApart(colour, statuses.slice(1).map((status) => ["converged", status] as const), ["achromatopsia"], clear);
  });
  it("has phases that every kind of colour vision tells apart, beside their letters", () => {
    expectApart(colour, pairsOf(phases), coloured, enough);
  });
  it("has two curves that are told apart, the second of which is dashed", () => {
    expectApart(colour, [["accent", "second"]], coloured, clear);
  });
  it("has rates that go one way from the worst to the best, whoever sees them", () => {
    const rate = rateColours([colour("rate-low"), colour("rate-middle"), colour("rate-high")]);
    const tenths = Array.from({ length: 11 }, (_, k) => rate(k / 10));
    for (const vision of visions) {
      const worst = seenAs(tenths[0] ?? "", vision);
      // Each tenth is noticed beside the next one, and farther from the worst than it.
      const apart = tenths.map((each) => distance(each, tenths[0] ?? "", vision));
      apart.slice(1).forEach((far, k) => expect(far - (apart[k] ?? 0), `${vision}, ${k + 1}0 % after ${worst}`).toBeGreaterThan(0.02));
      expect(apart[10]).toBeGreaterThan(3 * clear);
    }
  });
});

describe("colours as others see them", () => {
  it("are as they are to most, and grey without colour", () => {
    expect(seenAs("#cf8220", "normal")).toBe("#cf8220");
    expect(toOklab(seenAs("#cf8220", "achromatopsia"))[1]).toBeCloseTo(0, 3);
    expect(toOklab(seenAs("#cf8220", "achromatopsia"))[2]).toBeCloseTo(0, 3);
  });
  it("lose red from green, but not blue from yellow, where red or green cones are missing", () => {
    for (const vision of ["protanopia", "deuteranopia"] as const) {
      expect(distance("#c0504d", "#6b7f2a", vision)).toBeLessThan(0.5 * distance("#c0504d", "#6b7f2a", "normal"));
      expect(distance("#2050c0", "#c0a020", vision)).toBeGreaterThan(0.2);
    }
    expect(distance("#2f80d0", "#209080", "tritanopia")).toBeLessThan(0.5 * distance("#2f80d0", "#209080", "normal"));
  });
});
