import uPlot from "uplot";
import { useMemo } from "preact/hooks";
import { Chart, axis, faded, logTicks, percentTicks } from "../chart";
import type { Distribution } from "../documents";
import { axisLabel, metricName, unitText } from "../names";
import { percent, quantity } from "../numbers";
import { lastAtOrBelow } from "../statistics";

const stepped = (u: uPlot, series: number, from: number, to: number) => uPlot.paths.stepped?.({ align: 1 })(u, series, from, to) ?? null;

/** Whether a metric wants a log axis: it is positive, and its tail is far longer than its middle. */
export function isHeavyTailed(distribution: Distribution): boolean {
  const { x } = distribution;
  const low = x[Math.floor(0.05 * (x.length - 1))] ?? 0;
  const high = x[x.length - 1] ?? 0;
  return (x[0] ?? 0) > 0 && high / low > 300;
}

/** An empirical distribution function with its band, where that is narrower than everything. */
export function DistributionPlot({ distribution, height = 260 }: { distribution: Distribution; height?: number }) {
  const { x, f } = distribution;
  const band = distribution.band !== null && distribution.band.half_width < 1 ? distribution.band : null;
  const isLog = isHeavyTailed(distribution);
  const data = useMemo<uPlot.AlignedData>(() => {
    const half = band?.half_width ?? 0;
    return [x, f.map((share) => Math.min(1, share + half)), f.map((share) => Math.max(0, share - half)), f];
  }, [distribution]);
  const name = metricName(distribution.metric);
  const unit = unitText(distribution.unit);
  return (
    <Chart
      label={`Share of trials by ${name}: median ${quantity(x[lastAtOrBelow(f, 0.5)] ?? null, unit)}`}
      height={height}
      data={data}
      version={`${distribution.metric} ${isLog} ${band !== null}`}
      build={(palette) => ({
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: false } },
        scales: { x: { time: false, distr: isLog ? 3 : 1 }, y: { range: [0, 1] } },
        axes: [axis(palette, "bottom", { label: axisLabel(name, unit), ...(isLog ? logTicks("bottom") : {}) }), axis(palette, "left", { label: "share of trials", values: percentTicks })],
        bands: band ? [{ series: [1, 2], fill: faded(palette.accent, 0.18) }] : [],
        series: [
          {},
          { show: band !== null, stroke: "transparent", paths: stepped, points: { show: false } },
          { show: band !== null, stroke: "transparent", paths: stepped, points: { show: false } },
          { stroke: palette.accent, width: 2, paths: stepped, points: { show: x.length === 1 } },
        ],
      })}
      tooltip={(_u, k) => [`${percent(f[k] ?? 0)} at or below`, quantity(x[k] ?? 0, unit), ...(band ? [`± ${percent(band.half_width)}`] : [])]}
    />
  );
}

/** Two distributions over the same axis. */
export function TwoDistributions({ a, b, names }: { a: Distribution; b: Distribution; names: [string, string] }) {
  const data = useMemo<uPlot.AlignedData>(() => {
    const join = (d: Distribution): uPlot.AlignedData => [d.x, d.f];
    return uPlot.join([join(a), join(b)]);
  }, [a, b]);
  const at = (d: Distribution, x: number) => (x < (d.x[0] ?? Infinity) ? 0 : (d.f[lastAtOrBelow(d.x, x)] ?? 0));
  const unit = unitText(a.unit);
  return (
    <Chart
      label={`Settling times of ${names[0]} and ${names[1]}, as shares of the trials that converged`}
      height={280}
      data={data}
      build={(palette) => {
        const bandOf = (d: Distribution, colour: string): uPlot.Hooks.Defs["drawAxes"] => (u) => {
          if (!d.band || d.x.length === 0) return;
          const { ctx, bbox } = u;
          const half = d.band.half_width;
          ctx.save();
          ctx.beginPath();
          ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
          ctx.clip();
          ctx.fillStyle = faded(colour, 0.14);
          ctx.beginPath();
          const trace = (shift: number, from: number, to: number, step: number) => {
            let y = u.valToPos(Math.min(1, Math.max(0, (d.f[from] ?? 0) + shift)), "y", true);
            for (let k = from; k !== to + step; k += step) {
              const x = u.valToPos(d.x[k] ?? 0, "x", true);
              const next = u.valToPos(Math.min(1, Math.max(0, (d.f[k] ?? 0) + shift)), "y", true);
              if (step > 0) ctx.lineTo(x, y);
              ctx.lineTo(x, next);
              if (step < 0) ctx.lineTo(x, u.valToPos(Math.min(1, Math.max(0, (d.f[k - 1] ?? 0) + shift)), "y", true));
              y = next;
            }
          };
          trace(half, 0, d.x.length - 1, 1);
          trace(-half, d.x.length - 1, 0, -1);
          ctx.closePath();
          ctx.fill();
          ctx.restore();
        };
        return {
          legend: { show: false },
          cursor: { drag: { x: false, y: false }, points: { show: false } },
          scales: { x: { time: false }, y: { range: [0, 1] } },
          axes: [axis(palette, "bottom", { label: axisLabel("settling time", unit) }), axis(palette, "left", { label: "share of trials", values: percentTicks })],
          series: [
            {},
            { stroke: palette.accent, width: 2, paths: stepped, spanGaps: true, points: { show: a.x.length === 1 } },
            { stroke: palette.second, width: 2, dash: [7, 4], paths: stepped, spanGaps: true, points: { show: b.x.length === 1 } },
          ],
          hooks: { drawAxes: [bandOf(a, palette.accent), bandOf(b, palette.second)].flatMap((hook) => (hook ? [hook] : [])) },
        };
      }}
      tooltip={(u, k) => {
        const x = u.data[0][k] ?? 0;
        return [quantity(x, unit), `${names[0]}: ${percent(at(a, x))}`, `${names[1]}: ${percent(at(b, x))}`];
      }}
    />
  );
}
