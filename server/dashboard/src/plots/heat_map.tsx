import { useMemo, useState } from "preact/hooks";
import { rateColours, textOn } from "../colour";
import type { StudyView } from "../documents";
import { inputLabel, symbol, unitText } from "../names";
import { count, number, percentOf, percentRange, quantity } from "../numbers";
import { Card, Choice, Empty, Select } from "../parts";
import { useTheme } from "../theme";
import { RateLegend } from "./rate_legend";

type Sweeps = NonNullable<StudyView["sweeps"]>;

/** Number of the cell at these places along the axes: that of the last axis changes fastest. */
export function cellNumber(sizes: readonly number[], places: readonly number[]): number {
  return sizes.reduce((cell, size, k) => cell * size + (places[k] ?? 0), 0);
}

/** The success rate over any two swept inputs; the others stand still at values of the reader's choice. */
export function HeatMap({ sweeps }: { sweeps: Sweeps }) {
  const { palette } = useTheme();
  const { axes, cells } = sweeps;
  const [chosen, setChosen] = useState<[number, number]>([0, Math.min(1, axes.length - 1)]);
  const [places, setPlaces] = useState<number[]>(() => axes.map(() => 0));
  const [shown, setShown] = useState<"rate" | "time">("rate");
  const [looked, setLooked] = useState<number | null>(null);
  const colour = useMemo(() => rateColours(palette.rate), [palette]);
  const [xk, yk] = chosen;
  const x = axes[xk];
  const y = xk === yk ? null : axes[yk];
  const times = (cells?.settling_time ?? []).filter((time): time is number => time !== null);
  const [least, greatest] = [Math.min(...times), Math.max(...times)];
  if (!x) return null;
  if (!cells) {
    return (
      <Card title="Sweeps">
        <Empty title="Too many cells for a table"><p>Of more than 20,000 cells the map of any two inputs under “Why it fails” shows the rates.</p></Empty>
      </Card>
    );
  }
  const sizes = axes.map((axis) => axis.values.length);
  const cellAt = (i: number, j: number) => cellNumber(sizes, axes.map((_, k) => (k === xk ? i : y !== null && k === yk ? j : (places[k] ?? 0))));
  const isSmall = x.values.length <= 12;
  // Values grow to the right and upwards, whatever their order in the spec.
  const order = (values: readonly number[]) => values.map((_, k) => k).sort((a, b) => (values[a] ?? 0) - (values[b] ?? 0));
  const columns = order(x.values);
  const rows = y ? order(y.values).reverse() : [0];
  const options = axes.map((axis, k) => ({ value: String(k), text: symbol(axis.input) }));
  const text = (cell: number) => {
    const trials = cells.trials[cell] ?? 0;
    const successes = cells.successes[cell] ?? 0;
    const low = cells.low[cell] ?? null;
    const high = cells.high[cell] ?? null;
    return { trials, successes, low, high, rate: trials > 0 ? successes / trials : null, time: cells.settling_time[cell] ?? null };
  };
  const look = looked === null ? null : text(looked);
  const onKeyDown = (event: KeyboardEvent) => {
    const step = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
    if (!step) return;
    event.preventDefault();
    const cellsInSight = rows.map((j) => columns.map((i) => cellAt(i, j)));
    const row = cellsInSight.findIndex((each) => looked !== null && each.includes(looked));
    const column = row < 0 ? -1 : (cellsInSight[row] ?? []).indexOf(looked ?? -1);
    const to = (place: number, by: number, size: number) => Math.min(size - 1, Math.max(0, place + by));
    setLooked(row < 0 ? cellAt(columns[0] ?? 0, rows[0] ?? 0) : (cellsInSight[to(row, step[0] ?? 0, rows.length)]?.[to(column, step[1] ?? 0, columns.length)] ?? null));
  };
  const valuesOf = (cell: number) => {
    let rest = cell;
    return [...axes].reverse().map((axis) => {
      const place = rest % axis.values.length;
      rest = Math.floor(rest / axis.values.length);
      return `${symbol(axis.input)} = ${quantity(axis.values[place] ?? null, unitText(axis.unit))}`;
    }).reverse().join(", ");
  };
  return (
    <Card
      title={shown === "rate" ? "Success rate over the sweeps" : "Median settling time over the sweeps"}
      actions={<Choice label="Shown" value={shown} onChange={setShown} options={[{ value: "rate", text: "Success" }, { value: "time", text: "Settling time" }]} />}
    >
      {axes.length > 1 && (
        <div class="controls">
          <Select label="Across" value={String(xk)} options={options} onChange={(value) => setChosen([Number(value), Number(value) === yk ? xk : yk])} />
          <Select label="Up" value={String(yk)} options={options} onChange={(value) => setChosen([Number(value) === xk ? yk : xk, Number(value)])} />
          {axes.map((axis, k) => k !== xk && k !== yk && (
            <Select key={axis.input} label={`at ${symbol(axis.input)} =`} value={String(places[k] ?? 0)}
              options={axis.values.map((value, place) => ({ value: String(place), text: quantity(value, unitText(axis.unit)) }))}
              onChange={(value) => setPlaces(places.map((place, at) => (at === k ? Number(value) : place)))} />
          ))}
        </div>
      )}
      <div class="heat-scroll" tabIndex={0} role="group" aria-label="Heat map: arrow keys go through its cells" onKeyDown={onKeyDown}>
        <table class={`heat ${isSmall ? "" : "dense"}`} style={{ minWidth: `${64 + (isSmall ? 50 : 9) * columns.length}px` }} onMouseLeave={() => setLooked(null)}>
          <caption class="unseen">{shown === "rate" ? "Success rate" : "Median settling time"} by {symbol(x.input)}{y ? ` and ${symbol(y.input)}` : ""}</caption>
          <colgroup>
            {y && <col class="heat-title-column" />}
            <col class="heat-value-column" />
          </colgroup>
          <tbody>
            {rows.map((j, row) => (
              <tr key={j}>
                {y && row === 0 && <th rowSpan={rows.length} class="heat-title side"><span>{inputLabel(y.input, unitText(y.unit))}</span></th>}
                <th scope="row">{y ? number(y.values[j] ?? null) : ""}</th>
                {columns.map((i) => {
                  const cell = cellAt(i, j);
                  const { rate, low, high, time } = text(cell);
                  const share = shown === "rate" ? rate : time === null ? null : greatest > least ? 1 - (time - least) / (greatest - least) : 0.5;
                  const fill = share === null ? null : colour(share);
                  return (
                    <td key={i} class={looked === cell ? "looked" : ""} style={fill ? { background: fill, color: textOn(fill) } : {}}
                      onMouseEnter={() => setLooked(cell)} onClick={() => setLooked(cell)}>
                      {isSmall ? (shown === "rate" ? percentOf(rate, low, high) : number(time, 3)) : <span class="unseen">{shown === "rate" ? percentOf(rate, low, high) : number(time, 3)}</span>}
                    </td>
                  );
                })}
              </tr>
            ))}
          </tbody>
          <tfoot>
            <tr>
              {y && <td />}
              <td />
              {columns.map((i, column) => <th key={i} scope="col">{isSmall || column % Math.ceil(columns.length / 6) === 0 ? number(x.values[i] ?? null) : ""}</th>)}
            </tr>
            <tr>
              {y && <td />}
              <td />
              <th colSpan={columns.length} class="heat-title">{inputLabel(x.input, unitText(x.unit))}</th>
            </tr>
          </tfoot>
        </table>
      </div>
      {shown === "rate" ? <RateLegend /> : times.length > 0 && <RateLegend worst={quantity(greatest, "s", 3)} best={`${quantity(least, "s", 3)} to the goal`} />}
      <p class="look" aria-live="polite">
        {look && looked !== null ? (
          <>
            <strong>{valuesOf(looked)}</strong>: {count(look.successes)} of {count(look.trials)} converged, {percentOf(look.rate, look.low, look.high)}
            {" "}(interval {percentRange(look.low, look.high)}), median settling time {quantity(look.time, "s")}
          </>
        ) : (
          <span class="muted">Each cell's interval (level {number(100 * sweeps.level)} %) is told where you point, or go by the arrow keys.</span>
        )}
      </p>
    </Card>
  );
}
