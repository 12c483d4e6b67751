// Where a log axis has ticks, and which of them are named.
import { number, powerOfTen } from "./numbers";

/** Beyond so many decades, lines between powers of ten would be a grey wall. */
const finest = 5;

/**
 * 1 to 9 times each power of ten between two positive numbers; of many decades the powers alone, every second or third
 * of them where no more have room.
 */
export function logSplits(low: number, high: number, room = Infinity): number[] {
  const decades = Math.log10(high / low);
  const digits = decades <= finest ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : [1];
  const stride = decades <= finest ? 1 : Math.max(1, Math.ceil(decades / Math.max(1, room)));
  const splits: number[] = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    if (power % stride !== 0) continue;
    for (const digit of digits) {
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
