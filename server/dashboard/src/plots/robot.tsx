import { useEffect, useMemo, useRef } from "preact/hooks";
import { type TrialView } from "../documents";
import { number } from "../numbers";
import { phaseWords } from "../names";
import type { Player } from "../player";
import { interpolate, lastAtOrBelow } from "../statistics";

/** What the robot does at a time: the state between two points of the trajectory, and the phase. */
export function stateAt(view: TrialView, t: number) {
  const { trajectory, phases } = view;
  const at = (column: number[]) => interpolate(trajectory.t, column, t);
  const k = lastAtOrBelow(phases.start, t);
  const isKnown = phases.kind.length > 0 && (t <= (phases.end[k] ?? 0) || k < phases.kind.length - 1);
  return {
    q1: at(trajectory.q1), q2: at(trajectory.q2), q1_dot: at(trajectory.q1_dot), q2_dot: at(trajectory.q2_dot), tau: at(trajectory.tau),
    phase: isKnown ? (phases.kind[k] ?? null) : null,
  };
}

const width = 640;
const height = 300;
/** How much of its past the link's end leaves behind [s]. */
const trail = 6;

/** The robot seen from above at the player's time, with the goal as a ghost. */
export function Robot({ view, player }: { view: TrialView; player: Player }) {
  const { robot, references, trajectory } = view;
  // The schema knows the centre of mass alone; the link is drawn twice as long, as if it were uniform.
  const length = 2 * Math.abs(robot.d2);
  const sign = Math.sign(robot.d2) || 1;
  const scale = useMemo(() => {
    const low = Math.min(robot.q1_low, references.q1) - 1.15 * length;
    const high = Math.max(robot.q1_high, references.q1) + 1.15 * length;
    const perMetre = Math.min(width / (high - low), height / (2.35 * length));
    const middle = (low + high) / 2;
    return { perMetre, x: (x: number) => width / 2 + perMetre * (x - middle), y: (y: number) => height / 2 - perMetre * y, low: middle - width / 2 / perMetre, high: middle + width / 2 / perMetre };
  }, [view]);
  const slide = useRef<SVGGElement>(null);
  const link = useRef<SVGGElement>(null);
  const past = useRef<SVGPathElement>(null);
  const force = useRef<SVGPathElement>(null);
  const words = useRef<HTMLParagraphElement>(null);
  const unit = scale.perMetre;
  const L = length * unit * sign;
  const body = Math.max(10, Math.min(0.28 * length * unit, 40));
  const greatest = useMemo(() => Math.max(1e-9, percentile(trajectory.tau.map(Math.abs), 0.98)), [view]);

  useEffect(() => player.follow((t) => {
    const state = stateAt(view, t);
    const x = scale.x(state.q1);
    slide.current?.setAttribute("transform", `translate(${x.toFixed(2)} ${scale.y(0)})`);
    link.current?.setAttribute("transform", `rotate(${((-180 / Math.PI) * state.q2).toFixed(3)})`);
    const path: string[] = [];
    const from = Math.max(0, t - trail);
    for (let k = 0; k <= 90; ++k) {
      const s = from + ((t - from) * k) / 90;
      const q1 = interpolate(trajectory.t, trajectory.q1, s);
      const q2 = interpolate(trajectory.t, trajectory.q2, s);
      path.push(`${scale.x(q1 + sign * length * Math.cos(q2)).toFixed(1)} ${scale.y(sign * length * Math.sin(q2)).toFixed(1)}`);
    }
    past.current?.setAttribute("d", `M${path.join("L")}`);
    const push = 70 * Math.min(1, Math.abs(state.tau) / greatest) * Math.sign(state.tau);
    const side = Math.sign(push) * (body * 0.8 + 4);
    const tip = side + push;
    force.current?.setAttribute("d", Math.abs(push) < 2 ? "" : `M${side} 0H${tip}M${tip - Math.sign(push) * 6} -4L${tip} 0L${tip - Math.sign(push) * 6} 4`);
    if (words.current) {
      words.current.textContent = `t = ${t.toFixed(2)} s · ${state.phase ? phaseWords[state.phase] : "not listed"} · q₁ = ${fixed(state.q1)} m · q₂ = ${fixed(state.q2)} rad · q̇₂ = ${fixed(state.q2_dot)} rad/s`;
    }
  }), [player, view, scale]);

  const ticks = niceTicks(scale.low, scale.high);
  return (
    <div class="robot">
      <svg viewBox={`0 0 ${width} ${height}`} role="img" aria-label={`The robot from above: goal q1 = ${number(references.q1)} m, q2 = ${number(references.q2)} rad`}>
        <g class="robot-rail">
          <line x1="0" x2={width} y1={scale.y(0)} y2={scale.y(0)} />
          {ticks.map((tick) => (
            <g key={tick} transform={`translate(${scale.x(tick)} ${scale.y(0)})`}>
              <line y1="-4" y2="4" />
              <text y={height / 2 - 8}>{number(tick, 3)}{tick === ticks[ticks.length - 1] ? " m" : ""}</text>
            </g>
          ))}
        </g>
        <path class="robot-past" ref={past} />
        <g class="robot-goal" transform={`translate(${scale.x(references.q1)} ${scale.y(0)})`}>
          <rect x={-body * 0.8} y={-body / 2} width={body * 1.6} height={body} rx="4" />
          <g transform={`rotate(${(-180 / Math.PI) * references.q2})`}>
            <line x2={L} />
            <circle cx={L} r="5" />
          </g>
        </g>
        <g class="robot-body" ref={slide}>
          <rect x={-body * 0.8} y={-body / 2} width={body * 1.6} height={body} rx="4" />
          <path class="robot-force" ref={force} />
          <g ref={link}>
            <line class="robot-link" x2={L} />
            <circle class="robot-mass" cx={L / 2} r="4" />
            <circle class="robot-tip" cx={L} r="5" />
          </g>
          <circle class="robot-joint" r="6" />
        </g>
      </svg>
      <p class="robot-words" ref={words} />
    </div>
  );
}

const fixed = (value: number) => (Math.abs(value) >= 1000 ? number(value, 4) : value.toFixed(3).replace("-", "−"));

function percentile(values: number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
}

/** About seven round numbers between two. */
export function niceTicks(low: number, high: number): number[] {
  const raw = (high - low) / 7;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= raw) ?? 10 * power;
  const ticks: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) ticks.push(k * step);
  return ticks;
}
