// The little that the page computes itself: of bins that it makes of the trials at hand.
import type { Axis } from "./documents";

/** Wilson's interval of a proportion [Wilson 1927]; null without trials. @param z  normal quantile, of 95 % by default */
export function wilson(successes: number, trials: number, z = 1.959963984540054): { low: number; high: number } | null {
  if (trials === 0) return null;
  const share = successes / trials;
  const scale = 1 + (z * z) / trials;
  const centre = (share + (z * z) / (2 * trials)) / scale;
  const half = (z / scale) * Math.sqrt((share * (1 - share)) / trials + (z * z) / (4 * trials * trials));
  return { low: successes === 0 ? 0 : Math.max(0, centre - half), high: successes === trials ? 1 : Math.min(1, centre + half) };
}

export const binCount = (axis: Axis) => (axis.levels ?? axis.edges?.slice(1) ?? []).length;

/** Number of the bin that a value falls into, -1 where in none: [edge k, edge k + 1), the last one closed, or the level. */
export function binOf(axis: Axis, value: number): number {
  if (Number.isNaN(value)) return -1;
  if (axis.levels) {
    // Values and levels are both rounded to 6 digits, so the nearest is the one.
    let best = -1;
    axis.levels.forEach((level, k) => {
      if (best < 0 || Math.abs(level - value) < Math.abs((axis.levels?.[best] ?? 0) - value)) best = k;
    });
    return best;
  }
  const edges = axis.edges ?? [];
  const last = edges.length - 1;
  if (last < 1 || value < (edges[0] ?? 0) || value > (edges[last] ?? 0)) return -1;
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (value >= (edges[middle] ?? 0)) low = middle;
    else high = middle;
  }
  return low;
}

/** Centres of bins. */
export const centres = (axis: Axis): number[] =>
  axis.levels ?? (axis.edges ?? []).slice(1).map((edge, k) => (edge + (axis.edges?.[k] ?? 0)) / 2);

/** Trials and successes in the bins of a plane, x fastest. */
export function binPlane(x: Axis, y: Axis, xs: readonly number[], ys: readonly number[], succeeded: readonly boolean[]) {
  const columns = binCount(x);
  const trials = new Array<number>(columns * binCount(y)).fill(0);
  const successes = trials.slice();
  let outside = 0;
  succeeded.forEach((success, k) => {
    const i = binOf(x, xs[k] ?? NaN);
    const j = binOf(y, ys[k] ?? NaN);
    if (i < 0 || j < 0) {
      outside += 1;
      return;
    }
    trials[j * columns + i] = (trials[j * columns + i] ?? 0) + 1;
    if (success) successes[j * columns + i] = (successes[j * columns + i] ?? 0) + 1;
  });
  return { trials, successes, outside };
}

/** The same axis with fewer bins: each `of` one, for maps of few trials. */
export function coarser(axis: Axis, most: number): Axis {
  if (axis.levels || !axis.edges || axis.edges.length - 1 <= most) return axis;
  const bins = axis.edges.length - 1;
  const step = Math.ceil(bins / most);
  const edges = axis.edges.filter((_, k) => k % step === 0 || k === bins);
  return { ...axis, edges };
}

/** Index of the last value that is not above x, in rising values; 0 where all are. */
export function lastAtOrBelow(values: ArrayLike<number>, x: number): number {
  let low = 0;
  let high = values.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((values[middle] ?? 0) <= x) low = middle;
    else high = middle;
  }
  return low;
}

/** Where x falls between the points of a curve: linear between the two around it. */
export function interpolate(xs: readonly number[], ys: readonly number[], x: number): number {
  const k = lastAtOrBelow(xs, x);
  const x0 = xs[k] ?? 0;
  const x1 = xs[k + 1] ?? x0;
  const y0 = ys[k] ?? NaN;
  const y1 = ys[k + 1] ?? y0;
  const share = x1 > x0 ? Math.min(1, Math.max(0, (x - x0) / (x1 - x0))) : 0;
  return y0 + share * (y1 - y0);
}

/** Where an axis of cycles begins and ends: around few numbers of cycles there is room, so that their bars stay bars. */
export function cycleRange(least: number, most: number): [number, number] {
  const first = Math.max(0, least - Math.max(0, Math.ceil((6 - (most - least)) / 2)));
  return [first - 0.5, Math.max(most, first + 6) + 0.5];
}
