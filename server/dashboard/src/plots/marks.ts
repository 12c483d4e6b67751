// Trials as marks on a canvas: of each outcome its own shape.
import type uPlot from "uplot";
import { faded, ratio } from "../chart";
import type { Status } from "../documents";
import type { Palette } from "../theme";

export interface Points {
  index: readonly number[];
  status: readonly Status[];
  x: readonly number[];
  y: readonly number[];
}

/** @param marked  places of points in a ring @param canOpen  of an index, where not all can be opened: those that can have a ring too */
export function drawPoints(u: uPlot, context: CanvasRenderingContext2D, palette: Palette, points: Points, marked: readonly (number | null | undefined)[], canOpen: ((index: number) => boolean) | undefined): void {
  const many = points.x.length > 3000;
  const radius = (many ? 2 : points.x.length > 600 ? 2.8 : 4) * ratio();
  const opacity = many ? 0.7 : 0.85;
  const place = (k: number): [number, number] => [u.valToPos(points.x[k] ?? 0, "x", true), u.valToPos(points.y[k] ?? 0, "y", true)];
  // Successes first, so that failures are never hidden: they are what the reader looks for.
  context.fillStyle = faded(palette.status.converged, opacity);
  points.status.forEach((status, k) => {
    if (status !== "converged") return;
    const [px, py] = place(k);
    context.beginPath();
    context.arc(px, py, radius, 0, 2 * Math.PI);
    context.fill();
  });
  points.status.forEach((status, k) => {
    if (status === "converged") return;
    const [px, py] = place(k);
    drawMark(context, status, px, py, radius * 1.15, faded(palette.status[status], Math.min(1, opacity + 0.1)));
  });
  if (canOpen) {
    context.strokeStyle = palette.ink;
    context.lineWidth = 1.5 * ratio();
    points.index.forEach((index, k) => {
      if (!canOpen(index)) return;
      const [px, py] = place(k);
      context.beginPath();
      context.arc(px, py, radius + 3 * ratio(), 0, 2 * Math.PI);
      context.stroke();
    });
  }
  for (const k of marked) {
    if (k === null || k === undefined) continue;
    const [px, py] = place(k);
    context.strokeStyle = palette.ink;
    context.lineWidth = 2.5 * ratio();
    context.beginPath();
    context.arc(px, py, radius + 5 * ratio(), 0, 2 * Math.PI);
    context.stroke();
  }
}

/** The mark of a failure: of each kind its own shape. */
function drawMark(context: CanvasRenderingContext2D, status: Status, x: number, y: number, r: number, colour: string): void {
  context.fillStyle = colour;
  context.strokeStyle = colour;
  context.beginPath();
  switch (status) {
    case "converged":
      context.arc(x, y, r, 0, 2 * Math.PI);
      context.fill();
      return;
    case "timeout":
      context.lineWidth = 0.7 * r;
      context.moveTo(x - r, y - r);
      context.lineTo(x + r, y + r);
      context.moveTo(x + r, y - r);
      context.lineTo(x - r, y + r);
      context.stroke();
      return;
    case "singular":
      context.moveTo(x, y - 1.5 * r);
      context.lineTo(x + 1.5 * r, y);
      context.lineTo(x, y + 1.5 * r);
      context.lineTo(x - 1.5 * r, y);
      break;
    case "diverged":
      context.moveTo(x, y - 1.4 * r);
      context.lineTo(x + 1.4 * r, y + r);
      context.lineTo(x - 1.4 * r, y + r);
      break;
    case "integrator_failed":
      context.rect(x - r, y - r, 2 * r, 2 * r);
      break;
  }
  context.closePath();
  context.fill();
}
