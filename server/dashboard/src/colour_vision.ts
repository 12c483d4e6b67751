// Colours as eyes with fewer kinds of cones see them, for the palette's test.
import { fromLinear, toLinear, toOklab } from "./colour";

export const visions = ["normal", "protanopia", "deuteranopia", "tritanopia", "achromatopsia"] as const;
export type Vision = (typeof visions)[number];

const luminance = [0.2126, 0.7152, 0.0722] as const;

// Of linear sRGB: [Machado, Oliveira and Fernandes 2009], severity 1; without any cones that tell colours, luminance.
const matrices: Record<Vision, readonly (readonly [number, number, number])[]> = {
  normal: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritanopia: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
  achromatopsia: [luminance, luminance, luminance],
};

/** @param hex  "#rrggbb" */
export function seenAs(hex: string, vision: Vision): string {
  const [r, g, b] = toLinear(hex);
  return fromLinear(matrices[vision].map(([ofRed, ofGreen, ofBlue]) => ofRed * r + ofGreen * g + ofBlue * b) as [number, number, number]);
}

/** How far apart two colours look: the distance in Oklab. */
export function distance(a: string, b: string, vision: Vision): number {
  const [from, to] = [toOklab(seenAs(a, vision)), toOklab(seenAs(b, vision))];
  return Math.hypot(...from.map((each, k) => each - (to[k] ?? 0)));
}
