// Light or dark, as the reader's system says or as chosen here; and the colours, for what is drawn on canvas.
import { useEffect, useState } from "preact/hooks";
import type { PhaseKind, Status } from "./documents";

export type ThemeChoice = "system" | "light" | "dark";

const key = "steerstat-theme";
const media = matchMedia("(prefers-color-scheme: dark)");
const listeners = new Set<() => void>();

function stored(): ThemeChoice {
  try {
    const value = localStorage.getItem(key);
    return value === "light" || value === "dark" ? value : "system";
  } catch {
    return "system"; // a report opened from a file may have no storage
  }
}

let choice: ThemeChoice = stored();

function apply(): void {
  document.documentElement.dataset.theme = choice === "system" ? (media.matches ? "dark" : "light") : choice;
  for (const listener of listeners) listener();
}

media.addEventListener("change", apply);
apply();

export function chooseTheme(next: ThemeChoice): void {
  choice = next;
  try {
    if (next === "system") localStorage.removeItem(key);
    else localStorage.setItem(key, next);
  } catch {
    // then for this page alone
  }
  apply();
}

/** Colours for the canvas, from the style sheet, so that each stands in one place. */
export interface Palette {
  name: "light" | "dark";
  surface: string;
  ink: string;
  muted: string;
  line: string;
  accent: string;
  second: string;
  status: Record<Status, string>;
  phase: Record<PhaseKind, string>;
  /** The success rate's, from 0 over 1/2 to 1. */
  rate: [string, string, string];
}

function readPalette(): Palette {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
  return {
    name: document.documentElement.dataset.theme === "dark" ? "dark" : "light",
    surface: colour("surface"),
    ink: colour("ink"),
    muted: colour("muted"),
    line: colour("line"),
    accent: colour("accent"),
    second: colour("second"),
    status: {
      converged: colour("converged"),
      timeout: colour("timeout"),
      singular: colour("singular"),
      diverged: colour("diverged"),
      integrator_failed: colour("integrator-failed"),
    },
    phase: {
      align: colour("phase-align"),
      drift: colour("phase-drift"),
      contraction: colour("phase-contraction"),
      swing: colour("phase-swing"),
    },
    rate: [colour("rate-low"), colour("rate-middle"), colour("rate-high")],
  };
}

/** The theme chosen and its colours; draws anew when either changes. */
export function useTheme(): { choice: ThemeChoice; palette: Palette } {
  const [theme, setTheme] = useState(() => ({ choice, palette: readPalette() }));
  useEffect(() => {
    const update = () => setTheme({ choice, palette: readPalette() });
    listeners.add(update);
    return () => {
      listeners.delete(update);
    };
  }, []);
  return theme;
}
