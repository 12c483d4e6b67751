// Which trials failed, of the studies seen last: so that from a trial one can go on to the next that failed.
const known = new Map<string, readonly number[]>();

export function rememberFailed(id: string, indices: readonly number[]): void {
  known.delete(id);
  known.set(id, indices);
  for (const oldest of known.keys()) {
    if (known.size <= 10) break;
    known.delete(oldest);
  }
}

/** Rising; empty where they are not known. */
export const failedTrials = (id: string): readonly number[] => known.get(id) ?? [];
