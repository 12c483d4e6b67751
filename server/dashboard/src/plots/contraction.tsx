import uPlot from "uplot";
import { useMemo } from "preact/hooks";
import { Chart, axis, drawInside, faded, logTicks, ratio } from "../chart";
import type { TrialView } from "../documents";
import { number, quantity } from "../numbers";

type Contraction = TrialView["contraction"];

/** What each contraction cycle left of the error, on a log axis, against what was predicted. */
export function ContractionPlot({ contraction, of, height }: { contraction: Contraction; of: "distance" | "speed"; height: number }) {
  const before = of === "distance" ? contraction.distance_before : contraction.speed_before;
  const after = of === "distance" ? contraction.distance_after : contraction.speed_after;
  const predicted = of === "distance" ? contraction.distance_predicted : contraction.speed_predicted;
  const unit = of === "distance" ? "rad" : "rad/s";
  const size = before.length;
  const isDistance = of === "distance";
  const data = useMemo<uPlot.AlignedData>(() => [Array.from({ length: size }, (_, k) => k + 1), after.map(Math.abs)], [contraction, of]);
  const range = useMemo(() => {
    const values = [...before, ...after, ...predicted, ...(isDistance ? [...contraction.passive_error_after, contraction.tolerance] : [])].map(Math.abs).filter((value) => value > 0);
    const low = Math.min(...values);
    const high = Math.max(...values);
    return [low / 1.5, high * 1.5] as [number, number];
  }, [contraction, of]);
  const name = isDistance ? "|e|, distance to go" : "|ω|, speed";
  return (
    <Chart
      label={`${isDistance ? "Distance to go" : "Speed"} after each of ${size} contraction cycles, against what was predicted`}
      height={height}
      data={data}
      version={`${of} ${size} ${range}`}
      build={(palette) => ({
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
        padding: [8, 10, 0, 0],
        scales: { x: { time: false, range: [-0.2, size + 0.2] }, y: { distr: 3, range } },
        axes: [
          axis(palette, "bottom", { label: "contraction cycle", grid: false, values: (ticks) => ticks.map((tick) => (Number.isInteger(tick) ? String(tick) : "")) }),
          axis(palette, "left", { label: `${name} [${unit}]`, size: 54, ...logTicks("left") }),
        ],
        series: [{}, { stroke: "transparent", points: { show: false } }],
        hooks: {
          draw: [
            (u) =>
              drawInside(u, (context) => {
                const x = (k: number) => u.valToPos(k, "x", true);
                const y = (value: number) => u.valToPos(Math.max(range[0], Math.abs(value)), "y", true);
                if (isDistance) {
                  context.strokeStyle = palette.muted;
                  context.setLineDash([3 * ratio(), 4 * ratio()]);
                  context.lineWidth = ratio();
                  context.beginPath();
                  context.moveTo(u.bbox.left, y(contraction.tolerance));
                  context.lineTo(u.bbox.left + u.bbox.width, y(contraction.tolerance));
                  context.stroke();
                  context.setLineDash([]);
                  context.fillStyle = palette.muted;
                  context.font = `${11 * ratio()}px system-ui, sans-serif`;
                  context.textAlign = "left";
                  context.textBaseline = "bottom";
                  context.fillText("tolerance of ε", u.bbox.left + 6 * ratio(), y(contraction.tolerance) - 3 * ratio());
                }
                for (let k = 0; k < size; ++k) {
                  const from = before[k] ?? 0;
                  const to = after[k] ?? 0;
                  context.lineWidth = 1.5 * ratio();
                  context.strokeStyle = palette.second;
                  context.setLineDash([5 * ratio(), 4 * ratio()]);
                  context.beginPath();
                  context.moveTo(x(k), y(from));
                  context.lineTo(x(k + 1), y(predicted[k] ?? 0));
                  context.stroke();
                  context.setLineDash([]);
                  context.strokeStyle = palette.accent;
                  context.lineWidth = 2 * ratio();
                  context.beginPath();
                  context.moveTo(x(k), y(from));
                  context.lineTo(x(k + 1), y(to));
                  context.stroke();
                  // Hollow where the sign is another: beyond the goal, or away from it.
                  context.beginPath();
                  context.arc(x(k + 1), y(to), 3.5 * ratio(), 0, 2 * Math.PI);
                  context.fillStyle = to > 0 ? palette.accent : palette.surface;
                  context.fill();
                  context.stroke();
                  if (isDistance) {
                    context.fillStyle = faded(palette.ink, 0.55);
                    const error = y(contraction.passive_error_after[k] ?? 0);
                    context.fillRect(x(k + 1) - 3 * ratio(), error - 1 * ratio(), 6 * ratio(), 2 * ratio());
                  }
                }
              }),
          ],
        },
      })}
      tooltip={(_u, k) => {
        const from = before[k] ?? 0;
        const to = after[k] ?? 0;
        const lines = [`cycle ${k + 1}: ${quantity(from, unit)} to ${quantity(to, unit)}`, `left ${number(to / from, 3)}, predicted ${number((predicted[k] ?? 0) / from, 3)}`];
        return isDistance ? [...lines, `ε after it ${number(contraction.passive_error_after[k] ?? null, 3)}`] : lines;
      }}
    />
  );
}
