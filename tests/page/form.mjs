// The form of a new study.
import assert from "node:assert/strict";
import { it } from "node:test";
import { combined } from "./bench.mjs";
import { expectAccessible } from "./browser.mjs";

export function testForm(bench) {
  it("shows a bad spec's mistake at its field, in its line and in a list that leads there", async () => {
    await bench.show("#/");
    await bench.page.getByRole("link", { name: "New study" }).first().click();
    await bench.page.getByLabel("Start from").selectOption({ label: "combined" });
    const m1 = bench.page.locator('[data-pointer="/plant/m1"]');
    await m1.getByLabel("low").fill("1.5");
    await bench.page.getByRole("button", { name: "Run the study" }).click();
    await m1.locator(".mistakes", { hasText: "low < high" }).waitFor();
    assert.equal(await m1.getByLabel("low").getAttribute("aria-invalid"), "true");
    const text = await bench.page.getByLabel("Spec as JSON").inputValue();
    const line = text.split("\n").findIndex((each) => each.includes('"m1"')) + 1;
    assert.equal(await bench.page.locator(".editor-gutter .wrong").innerText(), String(line));
    await bench.page.getByRole("button", { name: "/plant/m1" }).first().click();
    assert.equal(await bench.page.evaluate(() => document.activeElement.closest("[data-pointer]").dataset.pointer), "/plant/m1");
    await expectAccessible(bench.page, "a refused spec");
    await m1.getByLabel("low").fill("0.8");
    assert.equal(await bench.page.locator(".mistakes").count(), 0);
  });

  it("keeps form and JSON one, and names the line of what is no JSON", async () => {
    const json = bench.page.getByLabel("Spec as JSON");
    const text = await json.inputValue();
    assert.deepEqual(JSON.parse(text), combined);
    await json.fill(text.replace('"horizon": 300,', '"horizon": 300,,'));
    await bench.page.getByText(/mistake in line \d+/).waitFor();
    assert.ok(await bench.page.getByRole("button", { name: "Run the study" }).isDisabled());
    await json.fill(text.replace('"horizon": 300', '"horizon": 250'));
    assert.equal(await bench.page.locator('[data-pointer="/horizon"] input').inputValue(), "250");
    await json.fill(text);
  });

  it("has fields for stopping rules and correlations, whose mistakes stand at their rows", async () => {
    await bench.show("#/new");
    const json = bench.page.getByLabel("Spec as JSON");
    const spec = async () => JSON.parse(await json.inputValue());
    await bench.page.locator("summary", { hasText: "When to stop" }).click();
    await bench.page.getByRole("button", { name: "Add a goal" }).click();
    await bench.page.getByLabel("Goal 1: metric").selectOption("settling_time");
    await bench.page.getByLabel("Goal 1: kind of width").selectOption("relative_half_width");
    const goal = bench.page.locator('[data-pointer="/stop/until/0"]');
    await goal.getByLabel("quantile").fill("0.9");
    await goal.getByLabel("at most").fill("0.05");
    await bench.page.locator('[data-pointer="/stop/check_every"] input').fill("500");
    assert.deepEqual((await spec()).stop, { until: [{ metric: "settling_time", quantile: 0.9, relative_half_width: 0.05 }], check_every: 500 });
    await bench.page.locator("summary", { hasText: "Correlations" }).click();
    await bench.page.getByRole("button", { name: "Add a correlation" }).click();
    const pair = bench.page.locator('[data-pointer="/sampling/correlation/0"]');
    await pair.getByLabel("Correlation 1: other input").selectOption("plant.f2");
    await pair.getByLabel("correlation", { exact: true }).fill("1.5");
    assert.deepEqual((await spec()).sampling.correlation, [["plant.m1", "plant.f2", 1.5]]);
    await bench.page.getByRole("button", { name: "Run the study" }).click();
    await pair.locator(".mistakes").waitFor();
    await expectAccessible(bench.page, "a refused correlation");
    await bench.page.getByRole("button", { name: "Take correlation 1 away" }).click();
    await bench.page.getByRole("button", { name: "Take goal 1 away" }).click();
    assert.deepEqual(await spec(), combined);
  });

  it("takes listed trials as a table, and tells which of its lines is none", async () => {
    await bench.show("#/new");
    await bench.page.getByLabel("Sampling: method").selectOption("explicit");
    const table = bench.page.getByLabel("Trials: names in the first line");
    await table.fill("plant.m1, plant.f2\n1.1, 0.02\n0.9, x");
    await bench.page.getByText("line 3: x is no number").waitFor();
    await table.fill("plant.m1, plant.f2\n1.1, 0.02\n0.9, 0");
    const { sampling } = JSON.parse(await bench.page.getByLabel("Spec as JSON").inputValue());
    assert.deepEqual(sampling, { seed: 1, method: "explicit", trials: [{ "plant.m1": 1.1, "plant.f2": 0.02 }, { "plant.m1": 0.9, "plant.f2": 0 }] });
    await expectAccessible(bench.page, "listed trials");
    await bench.page.getByLabel("Sampling: method").selectOption("monte_carlo");
    await bench.page.getByLabel("Trials", { exact: true }).waitFor();
  });
}
