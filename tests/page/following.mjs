// Studies as they run: followed, cancelled, deleted, and through the service's end.
import assert from "node:assert/strict";
import { it } from "node:test";
import { combinedOf } from "./bench.mjs";
import { watchShifts } from "./browser.mjs";

const chip = (page, text) => page.locator(".page-head .chip", { hasText: text });

export function testFollowing(bench) {
  let watched;

  it("sends a policy that allows nothing from elsewhere, and says so where there is no study", async () => {
    const response = await bench.page.goto(bench.service.url);
    const policy = response.headers()["content-security-policy"];
    assert.match(policy, /default-src 'none'/);
    assert.doesNotMatch(policy, /unsafe|https?:|\*/);
    await bench.page.getByText("No study yet").waitFor();
  });

  it("runs a study from the form and follows it to its end without anything jumping", async () => {
    // Longer, where the machine turns out to be quicker than it was a moment ago.
    let seen = [];
    for (let seconds = 4; seen.length < 3 && seconds < 1000; seconds *= 4) seen = await watch(await bench.trialsIn(seconds));
    assert.ok(seen.length >= 3, `progress was seen at ${seen.join(", ")} %`);
  });

  /** Runs a study from the form. @return the shares of its progress that were in sight [%] */
  async function watch(trials) {
    await bench.show("#/new");
    await bench.page.locator('[data-pointer="/name"] input').fill(`watched ${trials}`);
    await bench.page.getByLabel("Trials", { exact: true }).fill(String(trials));
    await bench.page.evaluate(() => {
      globalThis.seen = new Set();
      const look = () => globalThis.seen.add(document.querySelector(".head-progress [role=progressbar]")?.getAttribute("aria-valuenow") ?? "");
      new MutationObserver(look).observe(document.body, { subtree: true, childList: true, attributes: true });
    });
    await bench.page.getByRole("button", { name: "Run the study" }).click();
    await bench.page.getByRole("heading", { name: `watched ${trials}` }).waitFor();
    watched = { trials, id: /studies\/([0-9a-f]{16})/.exec(bench.page.url())[1] };
    await bench.page.locator(".headline .big").waitFor();
    const shifts = await watchShifts(bench.page);
    await chip(bench.page, "done").waitFor({ timeout: 240_000 });
    await bench.page.getByText(`${trials.toLocaleString("en")} trials`, { exact: true }).waitFor();
    const sum = await shifts();
    assert.ok(sum < 0.05, `what was in sight moved by ${sum}`);
    return (await bench.page.evaluate(() => [...globalThis.seen])).filter((share) => share !== "");
  }

  it("tells what the summary tells", async () => {
    await bench.show(`#/studies/${watched.id}`);
    const summary = await bench.service.get(`v1/studies/${watched.id}/summary`);
    assert.equal(summary.trials.completed, watched.trials);
    const share = Number((await bench.page.locator(".headline .big").innerText()).replace(" %", ""));
    assert.ok(Math.abs(share - 100 * summary.success_rate.estimate) < 0.051);
    const converged = await bench.page.locator(".outcomes tr", { hasText: "converged" }).locator("td").first().innerText();
    assert.equal(Number(converged.replace(/,/g, "")), summary.outcomes.converged);
  });

  it("goes on by itself when the service is killed and comes back", async () => {
    // The reference integrator is hundreds of times slower: long, with trials few enough for any machine's memory.
    const trials = Math.round((await bench.trialsIn(60)) / 300);
    const spec = { ...combinedOf("long", Math.max(2000, trials)), integrator: { method: "cvode" } };
    const response = await fetch(`${bench.service.url}v1/studies`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(spec) });
    assert.equal(response.status, 201);
    const { id } = await response.json();
    await bench.show(`#/studies/${id}`);
    await bench.page.locator(".headline .big").waitFor();
    await bench.service.kill();
    await bench.page.getByText("No connection to the service").first().waitFor();
    assert.equal(await bench.page.locator(".headline .big").count(), 1, "what was last seen stays in sight");
    const completed = () => bench.page.locator(".head-progress [role=progressbar]").getAttribute("aria-valuenow").then(Number);
    const before = await completed();
    await bench.service.start();
    await bench.page.locator(".connection[data-lost=false]").waitFor({ state: "attached" });
    await bench.page.waitForFunction((share) => Number(document.querySelector(".head-progress [role=progressbar]")?.getAttribute("aria-valuenow")) > share, before, { timeout: 120_000 });
    await bench.page.getByRole("button", { name: "Cancel long" }).click();
    await bench.page.getByRole("button", { name: /Cancel it/ }).click();
    await chip(bench.page, "cancelled").waitFor();
    await bench.page.getByRole("link", { name: "Studies" }).first().click();
    await bench.page.getByRole("link", { name: "long", exact: true }).waitFor();
  });

  it("deletes a study after asking back", async () => {
    await bench.show("#/");
    await bench.page.getByRole("button", { name: "Delete long" }).click();
    await bench.page.getByRole("button", { name: /Delete it/ }).click();
    await bench.page.getByRole("link", { name: "long", exact: true }).waitFor({ state: "detached" });
  });

  it("says so where a study or a view is not there", async () => {
    await bench.show("#/studies/0000000000000000");
    await bench.page.getByRole("heading", { name: "There is no such study" }).waitFor();
    await bench.show("#/elsewhere");
    await bench.page.getByRole("heading", { name: "There is no such view" }).waitFor();
  });
}
