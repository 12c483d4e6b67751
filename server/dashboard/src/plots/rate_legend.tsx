/** What the colours of rates mean, from the worst to the best. */
export function RateLegend({ worst = "0 %", best = "100 % converged" }: { worst?: string; best?: string }) {
  return (
    <p class="legend rate-legend" aria-hidden="true"><span>{worst}</span><span class="rate-ramp" /><span>{best}</span></p>
  );
}
