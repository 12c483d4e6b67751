// A spec's value: a number, a distribution or a sweep; as kinds with numbers in named places.
import { type Json, isObject } from "./pointer";

export const valueKinds = ["default", "number", "uniform", "normal", "truncated_normal", "lognormal", "triangular", "discrete", "sweep", "other"] as const;
export type ValueKind = (typeof valueKinds)[number];

export const kindWords: Record<ValueKind, string> = {
  default: "default",
  number: "fixed",
  uniform: "uniform",
  normal: "normal",
  truncated_normal: "truncated normal",
  lognormal: "lognormal",
  triangular: "triangular",
  discrete: "discrete",
  sweep: "sweep",
  other: "as in the JSON",
};

/** Numbers of a kind, in the order in which they are asked for; lists are told by their brackets. */
export const places: Record<ValueKind, readonly string[]> = {
  default: [],
  number: ["value"],
  uniform: ["low", "high"],
  normal: ["mean", "std"],
  truncated_normal: ["mean", "std", "low", "high"],
  lognormal: ["median", "sigma"],
  triangular: ["low", "mode", "high"],
  discrete: ["values[]", "weights[]"],
  sweep: ["values[]"],
  other: [],
};

const isNumber = (value: Json | undefined): value is number => typeof value === "number";
const areNumbers = (value: Json | undefined): value is number[] => Array.isArray(value) && value.every(isNumber);

export function kindOf(value: Json | undefined): ValueKind {
  if (value === undefined) return "default";
  if (isNumber(value)) return "number";
  if (!isObject(value)) return "other";
  const keys = Object.keys(value).filter((key) => key !== "relative");
  const key = keys.length === 1 ? keys[0] : undefined;
  if (key === "sweep") return areNumbers(value.sweep) ? "sweep" : "other";
  if (key === undefined || !(valueKinds as readonly string[]).includes(key)) return "other";
  const kind = key as ValueKind;
  const parts = partsOf(value, kind);
  const whole = places[kind].every((place) => (place.endsWith("[]") ? areNumbers(parts[place]) : isNumber(parts[place])));
  return whole && places[kind].length > 0 ? kind : "other";
}

/** The numbers of a value, by their places. */
export function partsOf(value: Json | undefined, kind: ValueKind): Record<string, Json | undefined> {
  if (kind === "number") return { value };
  if (!isObject(value)) return {};
  if (kind === "sweep") return { "values[]": value.sweep };
  const inner = value[kind];
  return Object.fromEntries(places[kind].map((place, k) => [place, Array.isArray(inner) ? inner[k] : isObject(inner) ? inner[place.replace("[]", "")] : undefined]));
}

export const isRelative = (value: Json | undefined): boolean => isObject(value) && value.relative === true;

/** The value with these numbers. */
export function build(kind: ValueKind, parts: Record<string, Json | undefined>, relative: boolean): Json | undefined {
  const part = (place: string): Json => parts[place] ?? 0;
  const extra = relative && kind !== "number" && kind !== "sweep" ? { relative: true } : {};
  switch (kind) {
    case "default":
    case "other":
      return undefined;
    case "number":
      return part("value");
    case "sweep":
      return { sweep: parts["values[]"] ?? [] };
    case "uniform":
    case "triangular":
      return { [kind]: places[kind].map(part), ...extra };
    default:
      return { [kind]: Object.fromEntries(places[kind].map((place) => [place.replace("[]", ""), parts[place] ?? (place.endsWith("[]") ? [] : 0)])), ...extra };
  }
}

/** What a kind begins with, around the number that was there. */
export function begin(kind: ValueKind, around: number): Record<string, Json> {
  const spread = Math.max(Math.abs(around) * 0.2, around === 0 ? 0.05 : 0);
  const low = round(around === 0 ? 0 : around - spread);
  const high = round(around + spread);
  const std = round(spread / 2);
  const all: Record<ValueKind, Record<string, Json>> = {
    default: {},
    other: {},
    number: { value: around },
    uniform: { low, high },
    normal: { mean: around, std },
    truncated_normal: { mean: around, std, low, high },
    lognormal: { median: around > 0 ? around : 1, sigma: 0.1 },
    triangular: { low, mode: around, high },
    discrete: { "values[]": [low, high], "weights[]": [1, 1] },
    sweep: { "values[]": [...new Set([low, around, high])] },
  };
  return all[kind];
}

const round = (value: number) => Number(value.toPrecision(6));

/** A number about which a value lies; what other kinds begin around. */
export function centre(value: Json | undefined, otherwise: number): number {
  const kind = kindOf(value);
  const parts = partsOf(value, kind);
  const at = (place: string) => (isNumber(parts[place]) ? parts[place] : undefined);
  const list = parts["values[]"];
  const low = at("low");
  const high = at("high");
  return at("value") ?? at("mean") ?? at("median") ?? at("mode") ?? (low !== undefined && high !== undefined ? round((low + high) / 2) : undefined) ?? (areNumbers(list) ? list[Math.floor(list.length / 2)] : undefined) ?? otherwise;
}

/** Numbers parted by commas or blanks; null where something else is among them. */
export function parseNumbers(text: string): number[] | null {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  const numbers = words.map(parseNumber);
  return numbers.every((number): number is number => number !== null) ? numbers : null;
}

/** A number as people write it; null for anything else. */
export function parseNumber(text: string): number | null {
  const plain = text.trim().replace(/^−/, "-");
  if (!/^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/.test(plain)) return null;
  const number = Number(plain);
  return Number.isFinite(number) ? number : null;
}
