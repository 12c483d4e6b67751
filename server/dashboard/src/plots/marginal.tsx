import uPlot from "uplot";
import { useMemo } from "preact/hooks";
import { Chart, axis, drawInside, faded, percentTicks, ratio } from "../chart";
import type { Marginal } from "../documents";
import { inputLabel, symbol, unitText } from "../names";
import { count, number, percentOf, percentRange, quantity } from "../numbers";
import { centres } from "../statistics";
import { extent } from "./plane";

/** The success rate along one input, with the interval of each bin. */
export function MarginalPlot({ marginal }: { marginal: Marginal }) {
  const { axis: along, trials, successes, low, high } = marginal;
  const data = useMemo<uPlot.AlignedData>(() => [
    centres(along),
    trials.map((n, k) => (n > 0 ? (successes[k] ?? 0) / n : null)),
  ], [marginal]);
  return (
    <Chart
      label={`Success rate along ${symbol(along.input)}`}
      height={176}
      data={data}
      version={`${along.input} ${extent(along)} ${trials.join()}`}
      build={(palette) => ({
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
        padding: [8, 8, 0, 0],
        scales: { x: { time: false, range: extent(along) }, y: { range: [0, 1] } },
        axes: [
          axis(palette, "bottom", { label: inputLabel(along.input, unitText(along.unit)), grid: false, space: 48, ...(along.levels && along.levels.length <= 8 ? { splits: () => along.levels ?? [] } : {}) }),
          axis(palette, "left", { values: percentTicks, size: 48, space: 30 }),
        ],
        series: [{}, { stroke: "transparent", points: { show: false } }],
        hooks: {
          draw: [
            (u) =>
              drawInside(u, (context) => {
                const at = (rate: number) => u.valToPos(rate, "y", true);
                trials.forEach((n, k) => {
                  const bottom = low[k] ?? null;
                  const top = high[k] ?? null;
                  if (n === 0 || bottom === null || top === null) return;
                  const rate = at((successes[k] ?? 0) / n);
                  context.fillStyle = faded(palette.accent, 0.22);
                  context.strokeStyle = palette.accent;
                  context.lineWidth = 2 * ratio();
                  context.beginPath();
                  if (along.edges) {
                    const left = u.valToPos(along.edges[k] ?? 0, "x", true);
                    const right = u.valToPos(along.edges[k + 1] ?? 0, "x", true);
                    context.fillRect(left, at(top), right - left, at(bottom) - at(top));
                    context.moveTo(left, rate);
                    context.lineTo(right, rate);
                  } else {
                    const centre = u.valToPos(along.levels?.[k] ?? 0, "x", true);
                    const half = 5 * ratio();
                    context.fillRect(centre - half, at(top), 2 * half, at(bottom) - at(top));
                    context.moveTo(centre - half, rate);
                    context.lineTo(centre + half, rate);
                  }
                  context.stroke();
                });
              }),
          ],
        },
      })}
      tooltip={(_u, k) => {
        const n = trials[k] ?? 0;
        const where = along.levels
          ? `${symbol(along.input)} = ${quantity(along.levels[k] ?? null, unitText(along.unit))}`
          : `${symbol(along.input)} ${number(along.edges?.[k])} to ${quantity(along.edges?.[k + 1] ?? null, unitText(along.unit))}`;
        if (n === 0) return [where, "no trial"];
        return [where, `${count(successes[k] ?? 0)} of ${count(n)}: ${percentOf((successes[k] ?? 0) / n, low[k] ?? null, high[k] ?? null)}`, percentRange(low[k] ?? null, high[k] ?? null)];
      }}
    />
  );
}
