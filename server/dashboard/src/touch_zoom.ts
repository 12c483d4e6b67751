// Two fingers zoom into a chart's x, one moves along it once it is zoomed; a double tap, as ever, shows all again. Up and
// down the page scrolls as if the chart were not there.
import uPlot from "uplot";

interface Range {
  min: number;
  max: number;
}

/** The shortest range that can be zoomed into, as a share of the whole. */
const least = 1e-3;

/**
 * The range that has the two values under the two fingers.
 * @param values  where the fingers were put down
 * @param places  where they are now, as shares of the chart's width from its left
 */
export function pinched(values: readonly [number, number], places: readonly [number, number], whole: Range): Range {
  const between = places[1] - places[0];
  const span = Math.abs(between) > 1e-3 ? (values[1] - values[0]) / between : Infinity;
  const wholeSpan = whole.max - whole.min;
  if (!(span > 0) || span >= wholeSpan) return whole;
  const width = Math.max(span, least * wholeSpan);
  return within({ min: values[0] - places[0] * width, max: values[0] + (1 - places[0]) * width }, whole);
}

/** A range moved back to where there are data. */
export function within(range: Range, whole: Range): Range {
  const shift = Math.max(0, whole.min - range.min) - Math.max(0, range.max - whole.max);
  return { min: Math.max(whole.min, range.min + shift), max: Math.min(whole.max, range.max + shift) };
}

export function touchZoom(): uPlot.Plugin {
  return {
    hooks: {
      ready: (u) => {
        const { over } = u;
        over.style.touchAction = "pan-y";
        /** Where each finger is, and the value that it was put on. */
        const fingers = new Map<number, { left: number; value: number }>();
        const whole = (): Range => ({ min: u.data[0][0] ?? 0, max: u.data[0][u.data[0].length - 1] ?? 1 });
        const show = (range: Range) => {
          const key = u.cursor.sync?.key;
          for (const chart of key === undefined || key === null ? [u] : uPlot.sync(key).plots) chart.setScale("x", range);
        };
        const left = (event: PointerEvent) => event.clientX - over.getBoundingClientRect().left;
        const put = (event: PointerEvent) => {
          if (event.pointerType !== "touch" || fingers.size === 2) return;
          fingers.set(event.pointerId, { left: left(event), value: u.posToVal(left(event), "x") });
          over.setPointerCapture(event.pointerId);
        };
        const move = (event: PointerEvent) => {
          const finger = fingers.get(event.pointerId);
          if (!finger) return;
          finger.left = left(event);
          const [one, other] = [...fingers.values()].sort((a, b) => a.value - b.value);
          if (!one) return;
          const width = over.clientWidth;
          const { min = 0, max = 1 } = u.scales.x as Partial<Range>;
          if (other) show(pinched([one.value, other.value], [one.left / width, other.left / width], whole()));
          else show(within({ min: one.value - (one.left / width) * (max - min), max: one.value + (1 - one.left / width) * (max - min) }, whole()));
        };
        const lift = (event: PointerEvent) => {
          fingers.delete(event.pointerId);
          // The finger that stays goes on from where it is.
          for (const finger of fingers.values()) finger.value = u.posToVal(finger.left, "x");
        };
        over.addEventListener("pointerdown", put);
        over.addEventListener("pointermove", move);
        for (const end of ["pointerup", "pointercancel"] as const) over.addEventListener(end, lift);
      },
    },
  };
}
