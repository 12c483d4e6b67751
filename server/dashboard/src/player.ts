/** The time that a trial is looked at, played or set; drawings follow it without the page being drawn anew. */
export class Player {
  private now: number;
  private frame = 0;
  private playing = false;
  private last = 0;
  private readonly listeners = new Set<(t: number) => void>();
  private readonly changes = new Set<() => void>();
  speed: number;

  constructor(
    readonly end: number,
    start = 0,
  ) {
    this.now = Math.min(end, Math.max(0, start));
    this.speed = usualSpeed(end);
  }

  get t(): number {
    return this.now;
  }

  get isPlaying(): boolean {
    return this.playing;
  }

  set(t: number): void {
    this.now = Math.min(this.end, Math.max(0, t));
    for (const listener of this.listeners) listener(this.now);
  }

  play(): void {
    if (this.playing) return;
    if (this.now >= this.end) this.set(0);
    this.playing = true;
    this.last = performance.now();
    const step = (time: number) => {
      if (!this.playing) return;
      // A page that was hidden must not jump on.
      const passed = Math.min(0.1, Math.max(0, (time - this.last) / 1000));
      this.last = time;
      this.set(this.now + this.speed * passed);
      if (this.now >= this.end) this.pause();
      else this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
    this.changed();
  }

  pause(): void {
    if (!this.playing) return;
    this.playing = false;
    cancelAnimationFrame(this.frame);
    this.changed();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.changed();
  }

  /** Calls the listener now and at every change of the time. @return what ends it */
  follow(listener: (t: number) => void): () => void {
    this.listeners.add(listener);
    listener(this.now);
    return () => this.listeners.delete(listener);
  }

  /** Of playing and speed. */
  onChange(listener: () => void): () => void {
    this.changes.add(listener);
    return () => this.changes.delete(listener);
  }

  private changed(): void {
    for (const listener of this.changes) listener();
  }
}

export const speeds = [0.5, 1, 2, 5, 10, 20] as const;

/** The speed at which a trial takes about half a minute. */
export const usualSpeed = (end: number) => speeds.find((speed) => end / speed <= 30) ?? speeds[speeds.length - 1] ?? 20;
