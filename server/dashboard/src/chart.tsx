// uPlot in a component: drawn anew with the theme, as wide as its place, with a tooltip and a text for those who do
// not see it. A chart's height is fixed, so that nothing around it moves.
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { logSplits, logTickTexts } from "./log_axis";
import { number } from "./numbers";
import { type Palette, useTheme } from "./theme";
import { touchZoom } from "./touch_zoom";

export type ChartOptions = Omit<uPlot.Options, "width" | "height">;

export interface ChartProps {
  /** What it shows, for readers of screens. */
  label: string;
  height: number;
  data: uPlot.AlignedData;
  build: (palette: Palette) => ChartOptions;
  /** Draws anew from build() when it changes; data alone is set without. */
  version?: string | number;
  /** Text at a point of the data; null for none. */
  tooltip?: (chart: uPlot, index: number) => string[] | null;
  /** Called with the chart, and with null when it is gone. */
  onChart?: (chart: uPlot | null) => void;
  /** Whether two fingers zoom into x, and one moves along it. (A mouse does by uPlot's own drag.) */
  canZoom?: boolean;
}

export function Chart({ label, height, data, build, version = 0, tooltip, onChart, canZoom = false }: ChartProps) {
  const { palette } = useTheme();
  const place = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot | null>(null);
  const shown = useRef(data);
  const latest = useRef({ tooltip, onChart });
  latest.current = { tooltip, onChart };

  useEffect(() => {
    const element = place.current;
    if (!element) return;
    const options = build(palette);
    if (tooltip) options.plugins = [...(options.plugins ?? []), tooltipPlugin((u, index) => latest.current.tooltip?.(u, index) ?? null)];
    if (canZoom) options.plugins = [...(options.plugins ?? []), touchZoom()];
    const made = new uPlot({ ...options, width: Math.max(80, element.clientWidth), height }, shown.current, element);
    chart.current = made;
    latest.current.onChart?.(made);
    const observer = new ResizeObserver(() => {
      const width = element.clientWidth;
      if (width > 0 && width !== made.width) made.setSize({ width, height });
    });
    observer.observe(element);
    return () => {
      observer.disconnect();
      latest.current.onChart?.(null);
      chart.current = null;
      made.destroy();
    };
  }, [palette, version, height]);

  useEffect(() => {
    if (shown.current === data) return;
    shown.current = data;
    chart.current?.setData(data);
  }, [data]);

  return <div class="chart" ref={place} style={{ height: `${height}px` }} role="img" aria-label={label} />;
}

function tooltipPlugin(text: (chart: uPlot, index: number) => string[] | null): uPlot.Plugin {
  const box = document.createElement("div");
  box.className = "tooltip";
  box.hidden = true;
  return {
    hooks: {
      init: (u) => u.over.appendChild(box),
      setCursor: (u) => {
        const { left = -1, top = -1, idx } = u.cursor;
        const lines = left < 0 || idx === null || idx === undefined ? null : text(u, idx);
        showTooltip(box, lines, left, top, u.over.clientWidth);
      },
    },
  };
}

/** Puts lines beside a point, on the side with room, within the chart. */
export function showTooltip(box: HTMLElement, lines: string[] | null, left: number, top: number, width: number): void {
  box.hidden = lines === null;
  if (!lines) return;
  box.replaceChildren(
    ...lines.map((line) => {
      const row = document.createElement("div");
      row.textContent = line;
      return row;
    }),
  );
  box.style.maxWidth = `${width}px`;
  const own = box.offsetWidth;
  const beside = left > width / 2 ? left - 12 - own : left + 12;
  // On a phone there may be room on neither side: then over the point, but whole.
  box.style.transform = `translate(${Math.round(Math.max(0, Math.min(width - own, beside)))}px, ${Math.round(top)}px) translate(0, -50%)`;
}

const font = "12px system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif";

export interface AxisOptions {
  label?: string;
  size?: number;
  values?: (values: number[]) => string[];
  grid?: boolean;
  space?: number;
  splits?: uPlot.Axis["splits"];
  filter?: uPlot.Axis["filter"];
}

/** An axis in the page's manner. */
export function axis(palette: Palette, side: "bottom" | "left", { label, size, values, grid = true, space, splits, filter }: AxisOptions = {}): uPlot.Axis {
  return {
    side: side === "bottom" ? 2 : 3,
    stroke: palette.muted,
    font,
    labelFont: font,
    labelSize: 20,
    labelGap: 2,
    size: side === "bottom" ? (size ?? 32) : (u, texts) => Math.max(size ?? 54, 12 + widest(u, texts ?? [])),
    gap: 4,
    space: space ?? (side === "bottom" ? 64 : 32),
    grid: { show: grid, stroke: palette.line, width: 1 },
    ticks: { show: true, stroke: palette.line, width: 1, size: 5 },
    border: { show: true, stroke: palette.line, width: 1 },
    values: (_u, ticks) => (values ? values(ticks) : ticks.map((tick) => (tick === null ? "" : number(tick, 6)))),
    ...(label === undefined ? {} : { label }),
    ...(splits === undefined ? {} : { splits }),
    ...(filter === undefined ? {} : { filter }),
  };
}

/** Width of the widest of some texts in an axis's font [CSS pixels]. */
function widest(u: uPlot, texts: readonly (string | null)[]): number {
  u.ctx.save();
  u.ctx.font = font;
  const width = texts.reduce((most, text) => Math.max(most, u.ctx.measureText(text ?? "").width), 0);
  u.ctx.restore();
  return Math.ceil(width);
}

export const percentTicks = (values: number[]) => values.map((value) => (value === null ? "" : `${number(100 * value, 3)} %`));

/** The ticks of a log axis. */
export const logTicks = (side: "bottom" | "left"): AxisOptions => ({
  splits: (u, _axis, low, high) => logSplits(low, high, side === "bottom" ? u.width / 56 : u.height / 28),
  filter: (_u, splits) => splits,
  values: logTickTexts,
});

/** Pixels of the canvas to one of the page. */
export const ratio = () => devicePixelRatio;

/** Runs a drawing with the plot's area as its bounds. */
export function drawInside(u: uPlot, draw: (context: CanvasRenderingContext2D) => void, room = 0): void {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left - room, bbox.top - room, bbox.width + 2 * room, bbox.height + 2 * room);
  ctx.clip();
  draw(ctx);
  ctx.restore();
}

/** A colour with an opacity. @param colour  "#rrggbb" */
export function faded(colour: string, opacity: number): string {
  return `${colour}${Math.round(255 * opacity).toString(16).padStart(2, "0")}`;
}
