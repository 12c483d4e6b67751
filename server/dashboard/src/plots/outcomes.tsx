import { type Summary, statuses } from "../documents";
import { count, percent } from "../numbers";
import { statusMeaning } from "../names";
import { StatusName } from "../parts";

/** How trials ended, as one bar and in numbers. */
export function Outcomes({ outcomes }: { outcomes: Summary["outcomes"] }) {
  const total = statuses.reduce((sum, status) => sum + outcomes[status], 0);
  return (
    <div class="outcomes">
      <div class="outcome-bar" aria-hidden="true">
        {statuses.map((status) => outcomes[status] > 0 && <div key={status} class={`fill-${status}`} style={{ flexGrow: outcomes[status] }} />)}
      </div>
      <table class="table plain">
        <thead class="unseen"><tr><th scope="col">Outcome</th><th scope="col">Trials</th><th scope="col">Share</th></tr></thead>
        <tbody>
          {statuses.map((status) => (
            <tr key={status} class={outcomes[status] === 0 ? "none" : ""} title={statusMeaning[status]}>
              <th scope="row"><StatusName status={status} /></th>
              <td class="right">{count(outcomes[status])}</td>
              <td class="right">{total > 0 && outcomes[status] > 0 ? percent(outcomes[status] / total) : "–"}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
