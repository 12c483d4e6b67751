import uPlot from "uplot";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { Chart, axis, drawInside, faded, ratio } from "../chart";
import type { PhaseKind, TrialView } from "../documents";
import type { Player } from "../player";
import { turns } from "./time_series";
import { stateAt } from "./robot";

/** From the least to the greatest speed; where a few violent moments would press the rest into a line, without them. */
export function speedRange(speeds: readonly number[]): [number, number] {
  const sorted = [...speeds].sort((a, b) => a - b);
  const at = (share: number) => sorted[Math.round(share * (sorted.length - 1))] ?? 0;
  const whole: [number, number] = [Math.min(0, at(0)), Math.max(0, at(1))];
  const most: [number, number] = [Math.min(0, at(0.01)), Math.max(0, at(0.99))];
  return whole[1] - whole[0] > 5 * (most[1] - most[0]) ? most : whole;
}

/** Of phases that colour alone would tell apart. */
const phaseDash: Partial<Record<PhaseKind, readonly number[]>> = { drift: [2, 3], swing: [7, 3] };

/** Angle and velocity of the passive joint, with the set from which a contraction cycle may begin. */
export function PhasePlane({ view, player, height }: { view: TrialView; player: Player; height: number }) {
  const { trajectory, phases, contraction_set: set } = view;
  const { rate } = view.contraction;
  const point = useRef<{ dot: HTMLElement; chart: uPlot } | null>(null);
  const [xs, ys] = useMemo(() => {
    const goals = turns(view.references.q2_nearest, trajectory.q2);
    const room = (low: number, high: number): [number, number] => [low - 0.06 * (high - low || 1), high + 0.06 * (high - low || 1)];
    return [room(Math.min(...trajectory.q2, ...goals), Math.max(...trajectory.q2, ...goals)), room(...speedRange(trajectory.q2_dot))] as const;
  }, [view]);
  const data = useMemo<uPlot.AlignedData>(() => [xs, [null, null]], [xs]);

  const place = (t: number) => {
    const now = point.current;
    if (!now) return;
    const state = stateAt(view, t);
    now.dot.style.transform = `translate(${now.chart.valToPos(state.q2, "x").toFixed(1)}px, ${now.chart.valToPos(state.q2_dot, "y").toFixed(1)}px)`;
  };
  useEffect(() => player.follow(place), [player]);

  return (
    <Chart
      label={`Phase plane of the passive joint: velocity over angle, with the set shaded in which ${view.policy === "paper" ? "contraction cycles begin" : "the policy brakes"}`}
      height={height}
      data={data}
      version={`${view.index}`}
      onChart={(chart) => {
        point.current = null;
        if (!chart) return;
        const dot = document.createElement("div");
        dot.className = "plane-dot";
        chart.over.appendChild(dot);
        point.current = { dot, chart };
        place(player.t);
      }}
      build={(palette) => ({
        legend: { show: false },
        cursor: { show: false },
        padding: [8, 10, 0, 0],
        scales: { x: { time: false, range: xs }, y: { range: ys } },
        axes: [axis(palette, "bottom", { label: "q₂ [rad]" }), axis(palette, "left", { label: "q̇₂ [rad/s]", size: 50 })],
        series: [{}, {}],
        hooks: {
          setSize: [() => place(player.t)],
          draw: [
            (u) =>
              drawInside(u, (context) => {
                const x = (value: number) => u.valToPos(value, "x", true);
                const y = (value: number) => u.valToPos(value, "y", true);
                const far = set.sigma > 0 ? Math.max(ys[1], 0) : Math.min(ys[0], 0);
                for (const goal of turns(set.q2_goal, [...xs])) {
                  const entry = set.q2_entry + goal - set.q2_goal;
                  const least = set.sigma * set.least_rate * Math.abs(set.q2_goal - set.q2_entry);
                  context.fillStyle = faded(palette.phase.contraction, 0.22);
                  context.strokeStyle = palette.phase.contraction;
                  context.lineWidth = ratio();
                  context.beginPath();
                  context.moveTo(x(goal), y(0));
                  context.lineTo(x(entry), y(least));
                  context.lineTo(x(entry), y(far));
                  context.lineTo(x(goal), y(far));
                  context.closePath();
                  context.fill();
                  context.stroke();
                  if (rate === null) continue;
                  context.strokeStyle = palette.ink;
                  context.setLineDash([4 * ratio(), 4 * ratio()]);
                  context.beginPath();
                  context.moveTo(x(goal), y(0));
                  context.lineTo(x(entry), y(set.sigma * rate * Math.abs(set.q2_goal - set.q2_entry)));
                  context.stroke();
                  context.setLineDash([]);
                }
                context.lineJoin = "round";
                context.lineWidth = 1.75 * ratio();
                const draw = (first: number, last: number, colour: string, dash: readonly number[] = []) => {
                  context.strokeStyle = colour;
                  context.setLineDash(dash.map((length) => length * ratio()));
                  context.beginPath();
                  for (let k = first; k <= last; ++k) context.lineTo(x(trajectory.q2[k] ?? 0), y(trajectory.q2_dot[k] ?? 0));
                  context.stroke();
                };
                phases.kind.forEach((kind, k) => draw(phases.first[k] ?? 0, phases.last[k] ?? 0, palette.phase[kind], phaseDash[kind]));
                const listed = phases.last[phases.last.length - 1] ?? 0;
                if (listed < trajectory.t.length - 1) draw(listed, trajectory.t.length - 1, palette.muted);
                context.setLineDash([]);
                context.strokeStyle = palette.second;
                context.lineWidth = 2 * ratio();
                for (const goal of turns(set.q2_goal, [...xs])) {
                  context.beginPath();
                  context.arc(x(goal), y(0), 6 * ratio(), 0, 2 * Math.PI);
                  context.stroke();
                }
              }),
          ],
        },
      })}
    />
  );
}
