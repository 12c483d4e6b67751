// Success over the plane of two inputs: points, or bins where there are too many.
import uPlot from "uplot";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { Chart, axis, drawInside, ratio, showTooltip } from "../chart";
import { rateColours } from "../colour";
import type { Axis } from "../documents";
import { inputLabel, statusWords, symbol, unitText } from "../names";
import { count, number, percentOf, percentRange, quantity } from "../numbers";
import { binCount, binOf, wilson } from "../statistics";
import type { Palette } from "../theme";
import { type Points, drawPoints } from "./marks";

export interface Bins {
  trials: readonly number[];
  successes: readonly number[];
}

export interface PlaneProps {
  x: Axis;
  y: Axis;
  /** One of the two. */
  points?: Points;
  bins?: Bins;
  /** A point's place in the lists, or a bin's number. */
  onPick: (place: number) => void;
  picked?: number | null;
  /** Of the points: those that can be opened, where not all can. */
  canOpen?: ((index: number) => boolean) | undefined;
  height: number;
}

/** Where an axis begins and ends; levels get half a step of room. */
export function extent(axis: Axis): [number, number] {
  const { edges, levels } = axis;
  if (edges) return [edges[0] ?? 0, edges[edges.length - 1] ?? 1];
  const values = levels ?? [0];
  const first = values[0] ?? 0;
  const last = values[values.length - 1] ?? first;
  const room = values.length > 1 ? (last - first) / (2 * (values.length - 1)) : Math.max(0.5, Math.abs(first) / 2);
  return [first - room, last + room];
}

/** An axis that some values fill, with a little room. */
export function axisOver(input: string, unit: string, values: readonly number[]): Axis {
  const low = values.reduce((least, value) => Math.min(least, value), Infinity);
  const high = values.reduce((greatest, value) => Math.max(greatest, value), -Infinity);
  const room = high > low ? 0.05 * (high - low) : 0.5;
  return { input, unit, edges: values.length > 0 ? [low - room, high + room] : [0, 1], levels: null };
}

/** Bounds of bin k. */
function bounds(axis: Axis, k: number): [number, number] {
  const { edges, levels } = axis;
  if (edges) return [edges[k] ?? 0, edges[k + 1] ?? 0];
  const all = levels ?? [];
  const here = all[k] ?? 0;
  const [low, high] = extent(axis);
  return [k > 0 ? (here + (all[k - 1] ?? here)) / 2 : low, k < all.length - 1 ? (here + (all[k + 1] ?? here)) / 2 : high];
}

export function Plane({ x, y, points, bins, onPick, picked = null, canOpen, height }: PlaneProps) {
  const chart = useRef<uPlot | null>(null);
  const box = useRef<HTMLDivElement | null>(null);
  const [focus, setFocus] = useState<number | null>(null);
  const props = useRef({ x, y, points, bins, onPick, picked, canOpen, focus });
  props.current = { x, y, points, bins, onPick, picked, canOpen, focus };
  const data = useMemo<uPlot.AlignedData>(() => [extent(x), [null, null]], [x]);
  const version = `${x.input} ${y.input} ${points ? "points" : "bins"} ${extent(x)} ${extent(y)}`;

  useEffect(() => {
    chart.current?.redraw(false);
  }, [points, bins, picked, focus, x, y]);

  const put = (u: uPlot | null) => {
    chart.current = u;
    if (!u) return;
    const tip = document.createElement("div");
    tip.className = "tooltip";
    tip.hidden = true;
    u.over.appendChild(tip);
    box.current = tip;
    const at = (event: MouseEvent) => {
      const area = u.over.getBoundingClientRect();
      return find(u, props.current, event.clientX - area.left, event.clientY - area.top);
    };
    u.over.addEventListener("mousemove", (event) => {
      const place = at(event);
      u.over.style.cursor = place === null ? "default" : "pointer";
      const area = u.over.getBoundingClientRect();
      showTooltip(tip, place === null ? null : describe(props.current, place), event.clientX - area.left, event.clientY - area.top, area.width);
    });
    u.over.addEventListener("mouseleave", () => {
      tip.hidden = true;
    });
    u.over.addEventListener("click", (event) => {
      const area = u.over.getBoundingClientRect();
      const place = find(u, props.current, event.clientX - area.left, event.clientY - area.top, props.current.canOpen);
      if (place !== null) props.current.onPick(place);
    });
  };

  // From the keyboard: arrows go through the points from left to right, or through the bins; Enter opens.
  const order = useMemo(() => (points ? points.x.map((_, k) => k).sort((a, b) => (points.x[a] ?? 0) - (points.x[b] ?? 0)) : null), [points]);
  const onKeyDown = (event: KeyboardEvent) => {
    const columns = binCount(x);
    const size = points ? points.x.length : columns * binCount(y);
    if (size === 0) return;
    const step = { ArrowRight: 1, ArrowLeft: -1, ArrowUp: points ? 10 : columns, ArrowDown: points ? -10 : -columns }[event.key];
    if (step !== undefined) {
      event.preventDefault();
      const rank = focus === null ? -1 : order ? order.indexOf(focus) : focus;
      const next = focus === null ? 0 : Math.min(size - 1, Math.max(0, rank + step));
      setFocus(order ? (order[next] ?? 0) : next);
    } else if (event.key === "Enter" && focus !== null) {
      event.preventDefault();
      onPick(focus);
    }
  };
  useEffect(() => setFocus(null), [x.input, y.input, points === undefined]);

  const label = `Success over ${symbol(x.input)} and ${symbol(y.input)}. Arrow keys go through the ${points ? "trials" : "bins"}, Enter opens`;
  return (
    <div class="plane">
      <div class="plane-keys" tabIndex={0} role="application" aria-label={label} onKeyDown={onKeyDown} onBlur={() => setFocus(null)}>
        <Chart
          label={label}
          height={height}
          data={data}
          version={version}
          onChart={put}
          build={(palette) => ({
            legend: { show: false },
            cursor: { show: false },
            scales: { x: { time: false, range: extent(x) }, y: { range: extent(y) } },
            axes: [
              axis(palette, "bottom", { label: inputLabel(x.input, unitText(x.unit)), grid: false, ...levelTicks(x) }),
              axis(palette, "left", { label: inputLabel(y.input, unitText(y.unit)), grid: false, ...levelTicks(y) }),
            ],
            series: [{}, {}],
            hooks: { draw: [(u) => draw(u, palette, props.current)] },
          })}
        />
      </div>
      <p class="unseen" aria-live="polite">{focus === null ? "" : describe({ x, y, points, bins }, focus).join(", ")}</p>
    </div>
  );
}

/** Of few levels: a tick each. */
function levelTicks(axis: Axis) {
  const levels = axis.levels;
  return levels && levels.length <= 12 ? { splits: () => levels } : {};
}

type Drawn = Pick<PlaneProps, "x" | "y" | "canOpen"> & { points?: Points | undefined; bins?: Bins | undefined; picked?: number | null; focus?: number | null };

function draw(u: uPlot, palette: Palette, { x, y, points, bins, picked, canOpen, focus }: Drawn): void {
  drawInside(u, (context) => {
    if (bins) {
      const colour = rateColours(palette.rate);
      const columns = binCount(x);
      const rectangle = (k: number): [number, number, number, number] => {
        const [x0, x1] = bounds(x, k % columns);
        const [y0, y1] = bounds(y, Math.floor(k / columns));
        const left = Math.round(u.valToPos(x0, "x", true));
        const top = Math.round(u.valToPos(y1, "y", true));
        return [left, top, Math.round(u.valToPos(x1, "x", true)) - left, Math.round(u.valToPos(y0, "y", true)) - top];
      };
      bins.trials.forEach((trials, k) => {
        if (trials === 0) return;
        context.fillStyle = colour((bins.successes[k] ?? 0) / trials);
        context.fillRect(...rectangle(k));
      });
      for (const [k, width] of [[picked, 2], [focus, 3]] as const) {
        if (k === null || k === undefined) continue;
        context.strokeStyle = palette.ink;
        context.lineWidth = width * ratio();
        context.strokeRect(...rectangle(k));
      }
    }
    if (points) drawPoints(u, context, palette, points, [picked, focus], canOpen);
  }, points ? 10 * ratio() : 0); // a mark on the edge stays whole
}

/** What is at a place of the plot's area [CSS pixels]: the nearest point within reach, or the bin. */
function find(u: uPlot, { x, y, points, bins }: Drawn, left: number, top: number, canOpen?: PlaneProps["canOpen"]): number | null {
  if (points) {
    let best: number | null = null;
    let least = 14 * 14;
    points.x.forEach((value, k) => {
      if (canOpen && !canOpen(points.index[k] ?? -1)) return;
      const dx = u.valToPos(value, "x") - left;
      const dy = u.valToPos(points.y[k] ?? 0, "y") - top;
      // A failure is picked before a success that is as near.
      const distance = dx * dx + dy * dy + (points.status[k] === "converged" ? 4 : 0);
      if (distance < least) {
        least = distance;
        best = k;
      }
    });
    return best;
  }
  if (!bins) return null;
  const i = binOf(x, u.posToVal(left, "x"));
  const j = binOf(y, u.posToVal(top, "y"));
  if (i < 0 || j < 0) return null;
  const k = j * binCount(x) + i;
  return (bins.trials[k] ?? 0) > 0 ? k : null;
}

export function describeBin(x: Axis, y: Axis, bins: Bins, k: number): { along: [string, string]; rate: string; interval: string } {
  const part = (axis: Axis, place: number) => {
    if (axis.levels) return `${symbol(axis.input)} = ${quantity(axis.levels[place] ?? null, unitText(axis.unit))}`;
    const [low, high] = bounds(axis, place);
    return `${symbol(axis.input)} ${number(low)} to ${quantity(high, unitText(axis.unit))}`;
  };
  const columns = binCount(x);
  const trials = bins.trials[k] ?? 0;
  const successes = bins.successes[k] ?? 0;
  const interval = wilson(successes, trials);
  return {
    along: [part(x, k % columns), part(y, Math.floor(k / columns))],
    rate: `${count(successes)} of ${count(trials)} converged${interval ? `: ${percentOf(successes / trials, interval.low, interval.high)}` : ""}`,
    interval: interval ? `95 % interval ${percentRange(interval.low, interval.high)}` : "",
  };
}

function describe({ x, y, points, bins }: Drawn, place: number): string[] {
  if (points) {
    return [
      `trial ${count(points.index[place] ?? 0)}: ${statusWords[points.status[place] ?? "converged"]}`,
      `${symbol(x.input)} = ${quantity(points.x[place] ?? null, unitText(x.unit))}`,
      `${symbol(y.input)} = ${quantity(points.y[place] ?? null, unitText(y.unit))}`,
    ];
  }
  if (!bins) return [];
  const { along, rate, interval } = describeBin(x, y, bins, place);
  return [...along, rate, ...(interval ? [interval] : [])];
}

