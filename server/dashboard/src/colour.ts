// Colours of a success rate: from orange (none) over grey to blue (all), each step lighter than the one before, or each
// darker, so that they are told apart with every kind of colour vision; mixed in Oklab, so that equal steps look equal
// [Ottosson 2020].

type Triple = [number, number, number];

const withoutGamma = (c: number) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const withGamma = (c: number) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

/** Red, green and blue as they add up. @param hex  "#rrggbb" */
export const toLinear = (hex: string) => [1, 3, 5].map((at) => withoutGamma(parseInt(hex.slice(at, at + 2), 16) / 255)) as Triple;

/** What lies outside the screen's colours is brought to their edge. */
export function fromLinear(linear: Triple): string {
  const byte = (c: number) => Math.round(255 * Math.min(1, Math.max(0, withGamma(c)))).toString(16).padStart(2, "0");
  return `#${linear.map(byte).join("")}`;
}

/** @param hex  "#rrggbb" */
export function toOklab(hex: string): Triple {
  const [r, g, b] = toLinear(hex);
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

export function fromOklab([L, a, b]: Triple): string {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return fromLinear([
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ]);
}

/** Colours of a rate in [0, 1], in 101 steps. @param stops  of 0, 1/2 and 1 */
export function rateColours(stops: readonly [string, string, string]): (rate: number) => string {
  const [low, middle, high] = stops.map(toOklab) as [Triple, Triple, Triple];
  const mix = (from: Triple, to: Triple, share: number) => from.map((v, k) => v + share * ((to[k] ?? 0) - v)) as Triple;
  const table = Array.from({ length: 101 }, (_, k) =>
    fromOklab(k <= 50 ? mix(low, middle, k / 50) : mix(middle, high, (k - 50) / 50)),
  );
  return (rate) => table[Math.round(100 * Math.min(1, Math.max(0, rate)))] ?? table[0] ?? "";
}

/** Black or white, whichever reads better on it: with a contrast of 4.5 at least, on any colour. */
export function textOn(hex: string): "#000000" | "#ffffff" {
  const [r, g, b] = toLinear(hex);
  const luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b; // as WCAG has it
  return luminance > 0.179 ? "#000000" : "#ffffff";
}
