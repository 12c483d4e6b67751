// Where a log axis has ticks, and which of them are named.
import { number, powerOfTen } from "./numbers";

/** 1 to 9 times each power of ten between two positive numbers. */
export function logSplits(low: number, high: number): number[] {
  const splits: number[] = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    for (let digit = 1; digit <= 9; ++digit) {
      const value = Number(`${digit}e${power}`);
      if (value >= low && value <= high) splits.push(value);
    }
  }
  return splits;
}

/** Short for what is far from 1: ticks of seven decades stand side by side on a phone. */
function tickText(value: number): string {
  const power = Math.round(Math.log10(value));
  return Math.abs(power) >= 4 && Number(`1e${power}`) === value ? powerOfTen(power) : number(value, 3);
}

/** Names powers of ten alone, so that they do not crowd; where there are fewer than two of them, 2 and 5 times them too. */
export function logTickTexts(values: readonly number[]): string[] {
  const leading = (value: number) => Number(value.toExponential(0).split("e")[0]);
  const named = values.filter((value) => leading(value) === 1).length >= 2 ? [1] : [1, 2, 5];
  return values.map((value) => (named.includes(leading(value)) ? tickText(value) : ""));
}
