// A column of the trajectory over time, with the phases shaded and named, the reference dashed, and the player's time.
import uPlot from "uplot";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { Chart, axis, drawInside, faded, ratio } from "../chart";
import type { PhaseKind, TrialView } from "../documents";
import { number } from "../numbers";
import { phaseShort, phaseWords } from "../names";
import type { Player } from "../player";
import type { Palette } from "../theme";

export type Column = "q1" | "q2" | "q1_dot" | "q2_dot" | "a" | "tau";

export const columnNames: Record<Column, { symbol: string; unit: string; plain: string }> = {
  q1: { symbol: "q₁", unit: "m", plain: "Position q1" },
  q2: { symbol: "q₂", unit: "rad", plain: "Angle q2" },
  q1_dot: { symbol: "q̇₁", unit: "m/s", plain: "Velocity of q1" },
  q2_dot: { symbol: "q̇₂", unit: "rad/s", plain: "Velocity of q2" },
  a: { symbol: "a", unit: "m/s²", plain: "Acceleration a" },
  tau: { symbol: "τ", unit: "N", plain: "Force tau" },
};

export function TimeSeries({ view, column, player, height, isNamed, isLast }: {
  view: TrialView;
  column: Column;
  player: Player;
  height: number;
  /** Whether phases are named in it: once a figure is enough. */
  isNamed: boolean;
  /** Whether it has the axis of time. */
  isLast: boolean;
}) {
  const { trajectory } = view;
  const head = useRef<{ line: HTMLElement; chart: uPlot } | null>(null);
  const data = useMemo<uPlot.AlignedData>(() => [trajectory.t, trajectory[column]], [view, column]);
  const { symbol, unit, plain } = columnNames[column];
  const levels = useMemo(() => referenceLevels(view, column), [view, column]);

  const place = (t: number) => {
    const now = head.current;
    if (!now) return;
    const x = now.chart.valToPos(t, "x");
    now.line.style.transform = `translateX(${x.toFixed(1)}px)`;
    now.line.hidden = x < 0 || x > now.chart.over.clientWidth;
  };
  useEffect(() => player.follow(place), [player]);

  const put = (chart: uPlot | null) => {
    head.current = null;
    if (!chart) return;
    const line = document.createElement("div");
    line.className = "playhead";
    chart.over.appendChild(line);
    head.current = { line, chart };
    let pressed = 0;
    chart.over.addEventListener("mousedown", (event) => {
      pressed = event.clientX;
    });
    chart.over.addEventListener("click", (event) => {
      if (Math.abs(event.clientX - pressed) > 3) return; // a zoom, not a click
      player.pause();
      player.set(chart.posToVal(event.clientX - chart.over.getBoundingClientRect().left, "x"));
    });
    place(player.t);
  };

  return (
    <Chart
      label={`${plain} over time, from ${number(trajectory[column][0])} to ${number(trajectory[column][trajectory.t.length - 1])} ${unit}`}
      height={height}
      data={data}
      version={`${column} ${view.index}`}
      onChart={put}
      canZoom
      build={(palette) => ({
        legend: { show: false },
        cursor: { sync: { key: "trial" }, drag: { x: true, y: false }, points: { show: true, size: 7 }, y: false },
        padding: [8, 16, 0, 0],
        scales: { x: { time: false }, y: { range: (_u, low, high) => withRoom(Math.min(low, ...levels), Math.max(high, ...levels), isNamed ? 0.2 : 0.08) } },
        axes: [
          axis(palette, "bottom", isLast ? { label: "t [s]" } : { values: (ticks) => ticks.map(() => ""), size: 8 }),
          axis(palette, "left", { label: `${symbol} [${unit}]`, size: 50, space: 26 }),
        ],
        series: [{}, { stroke: palette.accent, width: 1.75, points: { show: false } }],
        hooks: {
          drawClear: [(u) => shadePhases(u, palette, view)],
          // Over the grid, which would strike the names through.
          drawAxes: [(u) => drawReferences(u, palette, levels), ...(isNamed ? [(u: uPlot) => namePhases(u, palette, view)] : [])],
          setScale: [() => place(player.t)],
        },
      })}
      tooltip={(u, k) => [`${symbol} = ${number(u.data[1]?.[k] ?? null, 4)} ${unit}`, `t = ${number(u.data[0][k] ?? null, 5)} s`]}
    />
  );
}

/** @param above  share of the range that stays free at the top, for the names of phases */
function withRoom(low: number, high: number, above: number): [number, number] {
  const span = high > low ? high - low : Math.max(0.01, Math.abs(high));
  return [low - 0.08 * span, high + above * span];
}

/** The goal, and of the angle all its turns within the course. */
function referenceLevels(view: TrialView, column: Column): number[] {
  if (column === "q1") return [view.references.q1];
  if (column === "q2") return turns(view.references.q2_nearest, view.trajectory.q2);
  return column === "a" || column === "tau" ? [] : [0];
}

export function turns(angle: number, course: readonly number[]): number[] {
  const low = Math.min(angle, ...course);
  const high = Math.max(angle, ...course);
  const all: number[] = [];
  for (let k = Math.ceil((low - angle) / (2 * Math.PI)); angle + 2 * Math.PI * k <= high && all.length < 50; ++k) all.push(angle + 2 * Math.PI * k);
  return all.length > 0 ? all : [angle];
}

function drawReferences(u: uPlot, palette: Palette, levels: readonly number[]): void {
  drawInside(u, (context) => {
    context.strokeStyle = palette.second;
    context.lineWidth = 1.5 * ratio();
    context.setLineDash([7 * ratio(), 5 * ratio()]);
    for (const level of levels) {
      const y = u.valToPos(level, "y", true);
      context.beginPath();
      context.moveTo(u.bbox.left, y);
      context.lineTo(u.bbox.left + u.bbox.width, y);
      context.stroke();
    }
  });
}

/** Calls back with the phases that are in sight, and where they begin and end on the canvas. */
function eachPhase(u: uPlot, { phases }: TrialView, draw: (kind: PhaseKind, left: number, right: number) => void): void {
  phases.kind.forEach((kind, k) => {
    const left = Math.max(u.bbox.left, u.valToPos(phases.start[k] ?? 0, "x", true));
    const right = Math.min(u.bbox.left + u.bbox.width, u.valToPos(phases.end[k] ?? 0, "x", true));
    if (right > left) draw(kind, left, right);
  });
}

function shadePhases(u: uPlot, palette: Palette, view: TrialView): void {
  drawInside(u, (context) => {
    eachPhase(u, view, (kind, left, right) => {
      context.fillStyle = faded(palette.phase[kind], palette.name === "dark" ? 0.2 : 0.16);
      context.fillRect(left, u.bbox.top, right - left, u.bbox.height);
    });
  });
}

function namePhases(u: uPlot, palette: Palette, view: TrialView): void {
  drawInside(u, (context) => {
    context.font = `${11 * ratio()}px system-ui, sans-serif`;
    context.textBaseline = "top";
    context.textAlign = "center";
    context.fillStyle = palette.muted;
    eachPhase(u, view, (kind, left, right) => {
      const name = [phaseWords[kind], ...phaseShort[kind]].find((each) => context.measureText(each).width + 6 * ratio() < right - left);
      if (name !== undefined) context.fillText(name, (left + right) / 2, u.bbox.top + 4 * ratio());
    });
  });
}
