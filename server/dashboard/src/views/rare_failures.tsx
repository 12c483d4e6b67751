// How often failures are, where the trials were drawn to find them.
import { type Summary, statuses } from "../documents";
import { methodWords, statusWords } from "../names";
import { count, number, percent } from "../numbers";
import { Card, Figure } from "../parts";

export type RareFailures = NonNullable<Summary["rare_failures"]>;
type Subset = Extract<RareFailures, { method: "subset_simulation" }>;

/** The rate of failure with the interval that is to be relied on, and whether the estimate is. */
export function FailureRate({ rare, outcomes }: { rare: RareFailures; outcomes: Summary["outcomes"] }) {
  const { failure_rate: rate, nominal } = rare;
  const isPlain = rate.method === "clopper_pearson";
  return (
    <Card class="headline" title="Rate of failure" note={`Of the trials that ran ${statuses.filter((status) => outcomes[status] > 0).map((status) => `${count(outcomes[status])} ${statusWords[status]}`).join(", ")}: they were drawn where failures are, so that these counts are no rates.`}>
      {rare.trusted
        ? <p class="big">{number(rate.estimate, 3)}</p>
        : <p class="big">≤ {number(rate.ci_high, 3)}<span class="big-note"> the estimate, {number(rate.estimate, 3)}, is not to be trusted</span></p>}
      <p class="interval">{number(rate.ci_low, 3)} to {number(rate.ci_high, 3)}<span class="muted"> · {number(100 * rate.level)} % interval ({isPlain ? `${methodWords[rate.method]}, of the plain draws` : methodWords[rate.method]})</span></p>
      <p class={`verdict-line ${rare.trusted ? "pass" : "inconclusive"}`}>
        <span class="verdict"><span aria-hidden="true">{rare.trusted ? "✓" : "?"}</span> {rare.trusted ? "trusted" : "not trusted"}</span>
        {!rare.trusted && <span class="muted"> {rare.reason}</span>}
      </p>
      <dl class="figures">
        <Figure name="success rate">{rare.trusted ? `${number(100 * (1 - Math.min(1, rate.estimate)), 8)} %` : `≥ ${number(100 * (1 - rate.ci_high), 8)} %`}</Figure>
        {rare.trusted && <Figure name="standard error">{number(rate.standard_error, 3)}</Figure>}
        <Figure name="plain draws">{count(nominal.trials)}</Figure>
        <Figure name="failures among them">{count(nominal.failures)}</Figure>
        <Figure name="their interval alone">{number(nominal.ci_low, 3)} to {number(nominal.ci_high, 3)}</Figure>
      </dl>
    </Card>
  );
}

/** What the estimate stands on. */
export function RareDiagnostics({ rare }: { rare: RareFailures }) {
  if (rare.method === "subset_simulation") return <Levels rare={rare} />;
  return (
    <Card title="What it stands on" note="Importance sampling draws more where failures are supposed, and gives each trial its weight. An estimate is trusted where at least 20 effective failures count, none for more than a tenth, and all weights average to 1. What the proposal never draws none of these sees: the interval of the plain draws does.">
      <dl class="figures">
        <Figure name="failed draws">{count(rare.failures)}</Figure>
        <Figure name="effective failures">{number(rare.effective_failures, 3)}</Figure>
        <Figure name="largest failure's share">{percent(rare.largest_share)}</Figure>
        <Figure name="average weight">{number(rare.mean_weight, 4)}</Figure>
        <Figure name="effective draws">{number(rare.effective_draws, 4)}</Figure>
      </dl>
    </Card>
  );
}

const ends: Record<Subset["ended"], string> = {
  failure: "A tenth of the last level failed.",
  levels: "The last level allowed came before failure.",
  stagnation: "The threshold rose no more before failure.",
};

function Levels({ rare }: { rare: Subset }) {
  const { levels } = rare;
  const reached = levels.reduce<number[]>((all, level) => [...all, (all[all.length - 1] ?? 1) * level.probability], []);
  return (
    <Card title="Levels" note={`${ends[rare.ended]} The rate of failure is the product of the levels' shares; it varies by ${percent(rare.coefficient_of_variation, 0)} of itself. Accepted: of the chains' candidates, of which a tenth should be.`}>
      <div class="scroll" tabIndex={0} role="group" aria-label="Levels">
        <table class="table numbers">
          <thead>
            <tr>
              <th scope="col">Slower than</th><th scope="col" class="right">share</th><th scope="col" class="right">so far</th>
              <th scope="col" class="right">failed</th><th scope="col" class="right">accepted</th><th scope="col" class="right">varies by</th>
            </tr>
          </thead>
          <tbody>
            {levels.map((level, k) => (
              <tr key={k}>
                <th scope="row">{level.threshold === null ? "failure" : `${number(level.threshold, 4)} s`}</th>
                <td class="right">{number(level.probability, 3)}</td>
                <td class="right strong">{number(reached[k] ?? null, 3)}</td>
                <td class="right">{count(level.failures)}</td>
                <td class="right">{level.acceptance === null ? "–" : percent(level.acceptance)}</td>
                <td class="right">{percent(level.coefficient_of_variation, 0)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Card>
  );
}
