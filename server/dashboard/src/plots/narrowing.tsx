import uPlot from "uplot";
import { useMemo } from "preact/hooks";
import { Chart, axis, faded, logTicks, percentTicks } from "../chart";
import type { StudyView } from "../documents";
import { count, percentRange, percentOf } from "../numbers";

/** How the success rate and its interval narrowed as trials came in. */
export function Narrowing({ view }: { view: StudyView }) {
  const { narrowing } = view;
  const data = useMemo<uPlot.AlignedData>(() => [narrowing.trials, narrowing.high, narrowing.low, narrowing.estimate], [narrowing]);
  const last = narrowing.trials.length - 1;
  const isLog = (narrowing.trials[last] ?? 1) >= 20;
  return (
    <Chart
      label={`Success rate against the number of trials: ${percentOf(narrowing.estimate[last] ?? null, narrowing.low[last] ?? null, narrowing.high[last] ?? null)} after ${count(narrowing.of)}`}
      height={220}
      data={data}
      version={`${isLog} ${narrowing.trials[last]}`}
      build={(palette) => ({
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: false } },
        scales: { x: { time: false, distr: isLog ? 3 : 1, range: [narrowing.trials[0] ?? 1, Math.max(2, narrowing.trials[last] ?? 2)] }, y: { range: [0, 1] } },
        axes: [
          axis(palette, "bottom", { label: "trials", ...(isLog ? logTicks("bottom") : {}) }),
          axis(palette, "left", { label: "success rate", values: percentTicks }),
        ],
        bands: [{ series: [1, 2], fill: faded(palette.accent, 0.2) }],
        series: [
          {},
          { stroke: faded(palette.accent, 0.5), width: 1, points: { show: false } },
          { stroke: faded(palette.accent, 0.5), width: 1, points: { show: false } },
          { stroke: palette.accent, width: 2, points: { show: narrowing.trials.length < 3 } },
        ],
      })}
      tooltip={(_u, k) => [
        `after ${count(narrowing.trials[k] ?? 0)} trials`,
        percentOf(narrowing.estimate[k] ?? null, narrowing.low[k] ?? null, narrowing.high[k] ?? null),
        percentRange(narrowing.low[k] ?? null, narrowing.high[k] ?? null),
      ]}
    />
  );
}
