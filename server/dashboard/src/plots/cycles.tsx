import uPlot from "uplot";
import { useMemo } from "preact/hooks";
import { Chart, axis, drawInside } from "../chart";
import type { StudyView } from "../documents";
import { count } from "../numbers";
import { cycleRange } from "../statistics";

/** Trials by their number of contraction cycles, those that converged below the others. */
export function Cycles({ cycles }: { cycles: StudyView["cycles"] }) {
  const data = useMemo<uPlot.AlignedData>(() => [
    cycles.from.map((from, k) => (from + (cycles.to[k] ?? from)) / 2),
    cycles.converged.map((n, k) => n + (cycles.others[k] ?? 0)),
  ], [cycles]);
  const most = Math.max(1, ...(data[1] as number[]));
  const [first, last] = cycleRange(cycles.from[0] ?? 0, cycles.to[cycles.to.length - 1] ?? 0);
  return (
    <Chart
      label={`Trials by contraction cycles, from ${cycles.from[0] ?? 0} to ${cycles.to[cycles.to.length - 1] ?? 0}`}
      height={220}
      data={data}
      version={`${first} ${last} ${most}`}
      build={(palette) => ({
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: false } },
        scales: { x: { time: false, range: [first, last] }, y: { range: [0, 1.05 * most] } },
        axes: [
          axis(palette, "bottom", { label: "contraction cycles", grid: false, values: (ticks) => ticks.map((tick) => (Number.isInteger(tick) ? count(tick) : "")) }),
          axis(palette, "left", { label: "trials", values: (ticks) => ticks.map((tick) => (Number.isInteger(tick) ? count(tick) : "")) }),
        ],
        series: [{}, { stroke: "transparent", points: { show: false } }],
        hooks: {
          draw: [
            (u) =>
              drawInside(u, (context) => {
                const zero = u.valToPos(0, "y", true);
                cycles.from.forEach((from, k) => {
                  const left = u.valToPos(from - 0.5, "x", true);
                  const right = u.valToPos((cycles.to[k] ?? from) + 0.5, "x", true);
                  const gap = Math.min(2, 0.1 * (right - left));
                  const converged = u.valToPos(cycles.converged[k] ?? 0, "y", true);
                  const all = u.valToPos((cycles.converged[k] ?? 0) + (cycles.others[k] ?? 0), "y", true);
                  context.fillStyle = palette.status.converged;
                  context.fillRect(left + gap, converged, right - left - 2 * gap, zero - converged);
                  context.fillStyle = palette.status.timeout;
                  context.fillRect(left + gap, all, right - left - 2 * gap, converged - all);
                });
              }),
          ],
        },
      })}
      tooltip={(_u, k) => {
        const from = cycles.from[k] ?? 0;
        const to = cycles.to[k] ?? from;
        return [from === to ? `${count(from)} cycles` : `${count(from)} to ${count(to)} cycles`, `converged: ${count(cycles.converged[k] ?? 0)}`, `others: ${count(cycles.others[k] ?? 0)}`];
      }}
    />
  );
}
