// Numbers as text: a minus that is one, groups of three digits, no digits that mean nothing.

const superscripts: Record<string, string> = {
  "-": "⁻", "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴", "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹",
};

export const none = "–";

const grouped = (digits: string) => digits.replace(/\B(?=(\d{3})+(?!\d))/g, ",");
const signed = (text: string) => text.replace(/^-/, "−");

/** A whole number, in groups of three. */
export function count(value: number): string {
  return signed(grouped(String(Math.round(value))));
}

/** "1 trial", "2,000 trials". */
export const counted = (value: number, what: string) => `${count(value)} ${what}${value === 1 ? "" : "s"}`;

/** "10⁻⁴". */
export const powerOfTen = (exponent: number) => `10${[...String(exponent)].map((character) => superscripts[character] ?? "").join("")}`;

/** To so many significant digits, without zeros at the end. */
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return none;
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  if (magnitude >= 6 || magnitude < -3) {
    const [mantissa = "", exponent = ""] = value.toExponential(digits - 1).split("e");
    return `${signed(withoutZeros(mantissa))}×${powerOfTen(Number(exponent))}`;
  }
  const [whole = "", fraction] = withoutZeros(value.toFixed(Math.max(0, digits - 1 - magnitude))).split(".");
  return signed(grouped(whole) + (fraction === undefined ? "" : `.${fraction}`));
}

const withoutZeros = (text: string) => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);

/** A share as percent, with so many digits behind the point: "45.20 %". */
export function percent(share: number | null | undefined, digits = 1): string {
  if (share === null || share === undefined || !Number.isFinite(share)) return none;
  return `${signed((100 * share).toFixed(digits))} %`;
}

/** A share whose interval is that wide, to the digit that means something. */
export function percentOf(share: number | null, low: number | null, high: number | null): string {
  if (share === null) return none;
  return percent(share, digitsOf(low, high));
}

/** "43.0 to 47.4 %". */
export function percentRange(low: number | null, high: number | null): string {
  if (low === null || high === null) return none;
  const digits = digitsOf(low, high);
  return `${(100 * low).toFixed(digits)} to ${(100 * high).toFixed(digits)} %`;
}

const digitsOf = (low: number | null, high: number | null) => {
  const width = low === null || high === null ? 0.1 : 100 * (high - low);
  return width > 20 ? 0 : width > 1 ? 1 : width > 0.1 ? 2 : 3;
};

/** With its unit, where it has one. */
export const quantity = (value: number | null, unit: string, digits = 4) =>
  value === null || unit === "1" ? number(value, digits) : `${number(value, digits)} ${unit}`;

/** Seconds, for people: "12 s", "3 min 20 s", "18 min", "1 h 5 min". */
export function duration(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return none;
  if (seconds < 1) return "under 1 s";
  const whole = Math.round(seconds);
  if (whole < 60) return `${whole} s`;
  if (whole < 600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  const minutes = Math.round(whole / 60);
  return minutes < 60 ? `${minutes} min` : `${grouped(String(Math.floor(minutes / 60)))} h ${minutes % 60} min`;
}

/** How long ago, for people; the exact time is for the title. */
export function ago(time: string, now: number): string {
  const seconds = (now - Date.parse(time)) / 1000;
  if (!Number.isFinite(seconds)) return time;
  if (seconds < 60) return "just now";
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  if (seconds < 86400) return `${Math.floor(seconds / 3600)} h ago`;
  if (seconds < 14 * 86400) return `${Math.floor(seconds / 86400)} d ago`;
  return time.slice(0, 10);
}
