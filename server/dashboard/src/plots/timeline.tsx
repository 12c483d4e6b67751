import { useEffect, useRef, useState } from "preact/hooks";
import type { PhaseKind, TrialView } from "../documents";
import { number } from "../numbers";
import { phaseShort, phaseWords } from "../names";
import { type Player, speeds } from "../player";

export const phaseKinds: readonly PhaseKind[] = ["align", "drift", "contraction", "swing"];

/** Play, pause and scrub, over the phases as they follow one another. */
export function Timeline({ view, player }: { view: TrialView; player: Player }) {
  const [, draw] = useState(0);
  const slider = useRef<HTMLInputElement>(null);
  const clock = useRef<HTMLOutputElement>(null);
  useEffect(() => player.onChange(() => draw((n) => n + 1)), [player]);
  useEffect(() => player.follow((t) => {
    if (slider.current) {
      slider.current.value = String(t);
      slider.current.setAttribute("aria-valuetext", `${t.toFixed(1)} seconds`);
    }
    if (clock.current) clock.current.value = `${t.toFixed(1)} s`;
  }), [player]);
  useEffect(() => () => player.pause(), [player]);
  const { phases } = view;
  const end = player.end;
  const starts = phases.start;
  const jump = (direction: 1 | -1) => {
    player.pause();
    const t = player.t;
    const next = direction > 0 ? starts.find((start) => start > t + 1e-6) : [...starts].reverse().find((start) => start < t - 1e-6);
    player.set(next ?? (direction > 0 ? end : 0));
  };
  return (
    <div class="timeline">
      <div class="timeline-bar">
        <svg class="phases" viewBox={`0 0 ${end || 1} 1`} preserveAspectRatio="none" aria-hidden="true">
          {phases.kind.map((kind, k) => (
            <rect key={k} x={starts[k]} width={Math.max(0, (phases.end[k] ?? 0) - (starts[k] ?? 0))} height="1" class={`phase-${kind}`}>
              <title>{phaseWords[kind]}</title>
            </rect>
          ))}
        </svg>
        <input ref={slider} type="range" aria-label="Time" min="0" max={end} step={Math.max(0.001, end / 2000)} onInput={(event) => {
          player.pause();
          player.set(Number(event.currentTarget.value));
        }} />
      </div>
      <div class="timeline-controls">
        <button type="button" class="button icon" aria-label="Phase before" title="Phase before" onClick={() => jump(-1)}><StepIcon /></button>
        <button type="button" class="button primary play" aria-label={player.isPlaying ? "Pause" : "Play"} onClick={() => (player.isPlaying ? player.pause() : player.play())}>
          {player.isPlaying ? "Pause" : "Play"}
        </button>
        <button type="button" class="button icon" aria-label="Next phase" title="Next phase" onClick={() => jump(1)}><StepIcon isForward /></button>
        <output class="clock" ref={clock}>0.0 s</output>
        <label class="select"><span>Speed</span>
          <select value={String(player.speed)} onChange={(event) => player.setSpeed(Number(event.currentTarget.value))}>
            {speeds.map((speed) => <option key={speed} value={String(speed)}>{number(speed)}×</option>)}
          </select>
        </label>
        <PhaseLegend view={view} />
      </div>
    </div>
  );
}

/** A bar and an arrow: to the next phase, or back. */
function StepIcon({ isForward = false }: { isForward?: boolean }) {
  return (
    <svg viewBox="0 0 16 16" width="14" height="14" aria-hidden="true" transform={isForward ? "scale(-1 1)" : ""}>
      <path d="M3 2.5v11" stroke="currentColor" stroke-width="2" stroke-linecap="round" />
      <path d="M13.5 2.8v10.4L5.8 8Z" fill="currentColor" />
    </svg>
  );
}

export function PhaseLegend({ view, reference }: { view: TrialView; reference?: string | undefined }) {
  return (
    <p class="legend phase-legend">
      {phaseKinds.filter((kind) => view.phases.kind.includes(kind)).map((kind) => (
        <span key={kind}><span class={`swatch phase-${kind}`} aria-hidden="true">{phaseShort[kind][1]}</span> {phaseWords[kind]}</span>
      ))}
      {reference !== undefined && <span><span class="line-sample dashed" aria-hidden="true" /> {reference}</span>}
    </p>
  );
}
