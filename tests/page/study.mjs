// A study's figures, and what leads from them to its trials.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { it } from "node:test";
import { runProgram } from "./service.mjs";

export function testStudy(bench) {
  it("maps the rates of very many trials, and lists the trials of a bin", async () => {
    const id = await bench.study("many");
    await bench.show(`#/studies/${id}`);
    await bench.page.getByRole("link", { name: "Why it fails" }).click();
    await bench.page.getByText("All 30,000 trials", { exact: false }).waitFor();
    const over = bench.page.locator(".map-card .u-over");
    const box = await over.boundingBox();
    await over.click({ position: { x: box.width * 0.9, y: box.height * 0.8 } });
    const look = bench.page.locator(".map-card .look");
    await look.getByText(/\d+ of \d+ converged/).waitFor();
    await bench.page.getByLabel("Across").selectOption("plant.m1");
    await bench.page.waitForURL(/x=plant\.m1/);
  });

  it("opens the very trial that failed and was clicked on the map", async () => {
    const small = await bench.study("small");
    await bench.show(`#/studies/${small}/why?x=plant.f2&y=initial_state.q2_dot`);
    const view = await bench.service.get(`v1/studies/${small}/view`);
    const column = (input) => view.sample.inputs[view.inputs.findIndex((each) => each.input === input)];
    const edges = (input) => view.marginals.find((each) => each.axis.input === input).axis.edges;
    const over = bench.page.locator(".map-card .u-over");
    const box = await over.boundingBox();
    const [xs, ys] = [column("plant.f2"), column("initial_state.q2_dot")];
    const [ex, ey] = [edges("plant.f2"), edges("initial_state.q2_dot")];
    const places = xs.map((x, k) => ({
      left: ((x - ex[0]) / (ex.at(-1) - ex[0])) * box.width,
      top: (1 - (ys[k] - ey[0]) / (ey.at(-1) - ey[0])) * box.height,
    }));
    const room = (k) => Math.min(...places.map((each, j) => (j === k ? Infinity : Math.hypot(each.left - places[k].left, each.top - places[k].top))));
    const inside = ({ left, top }) => left > 8 && top > 8 && left < box.width - 8 && top < box.height - 8;
    const failed = places.map((_, k) => k).filter((k) => view.sample.status[k] !== 0 && inside(places[k]));
    const loneliest = failed.reduce((best, k) => (room(k) > room(best) ? k : best), failed[0]);
    await over.click({ position: { x: places[loneliest].left, y: places[loneliest].top } });
    await bench.page.getByRole("heading", { name: `Trial ${view.sample.index[loneliest]}`, exact: true }).waitFor();
    await bench.page.locator(".facts .outcome").waitFor();
    assert.doesNotMatch(await bench.page.locator(".facts .outcome").innerText(), /converged/);
  });

  it("opens a trial from the map by keyboard alone", async () => {
    const small = await bench.study("small");
    await bench.show(`#/studies/${small}/why`);
    await bench.page.locator(".plane-keys").focus();
    for (let k = 0; k < 5; ++k) await bench.page.keyboard.press("ArrowRight");
    const told = await bench.page.locator(".plane [aria-live]").innerText();
    await bench.page.keyboard.press("Enter");
    await bench.page.getByRole("heading", { name: `Trial ${/trial ([\d,]+)/.exec(told)[1].replace(",", "")}`, exact: true }).waitFor();
  });

  it("hands out a study's result file, which the program reads", async () => {
    const id = await bench.study("few");
    await bench.show(`#/studies/${id}`);
    const [download] = await Promise.all([bench.page.waitForEvent("download"), bench.page.getByRole("link", { name: "Download the result file of few" }).click()]);
    assert.equal(download.suggestedFilename(), `${id}.h5`);
    const file = await download.path();
    const served = await fetch(`${bench.service.url}v1/studies/${id}/results.h5`);
    assert.ok(readFileSync(file).equals(Buffer.from(await served.arrayBuffer())), "it is what the service has");
    const summary = JSON.parse(runProgram("show", file, "--json").toString());
    assert.equal(summary.trials.completed, 40);
    assert.equal(summary.study.id, id);
  });

  it("extends a study from its own spec by more trials, of which the first are those it had", async () => {
    const id = await bench.study("few");
    await bench.show("#/");
    await bench.page.getByRole("link", { name: "Extend or vary few", exact: true }).click();
    await bench.page.getByText("those that are finished are taken over").waitFor();
    await bench.page.waitForFunction(() => document.querySelector('[data-pointer="/name"] input')?.value === "few");
    await bench.page.locator('[data-pointer="/name"] input').fill("few and more");
    await bench.page.getByLabel("Trials", { exact: true }).fill("60");
    await bench.page.getByRole("button", { name: "Run the study" }).click();
    await bench.page.getByRole("heading", { name: "few and more" }).waitFor();
    await bench.page.locator(".page-head .chip", { hasText: "done" }).waitFor();
    await bench.page.getByText("60 trials", { exact: true }).waitFor();
    const extended = /studies\/([0-9a-f]{16})/.exec(bench.page.url())[1];
    assert.notEqual(extended, id);
    const [before, after] = await Promise.all([id, extended].map((each) => bench.service.get(`v1/studies/${each}/trials?limit=40`)));
    assert.equal(before.trials.length, 40);
    assert.deepEqual(after.trials, before.trials);
  });

  it("compares two studies that are chosen in the list", async () => {
    await Promise.all([bench.study("small"), bench.study("other")]);
    await bench.show("#/");
    await bench.page.getByLabel("Choose small for a comparison").check();
    await bench.page.getByLabel("Choose other for a comparison").check();
    await bench.page.getByRole("button", { name: "Compare 2/2" }).click();
    const pairs = bench.page.locator(".pairs .pair strong");
    await pairs.first().waitFor();
    const counts = (await pairs.allInnerTexts()).map(Number);
    assert.equal(counts.reduce((sum, n) => sum + n, 0), 300);
    await bench.page.getByText("/controller/contraction/eta2").waitFor();
    const rows = bench.page.locator("[aria-label='Discordant trials'] tbody tr");
    assert.equal(await rows.count(), Math.min(200, counts[1] + counts[2]));
  });

  it("shows sweeps as a heat map with each cell's interval", async () => {
    const swept = await bench.study("swept");
    await bench.show(`#/studies/${swept}`);
    const cells = bench.page.locator(".heat tbody td");
    await cells.first().waitFor();
    assert.equal(await cells.count(), 25);
    await cells.nth(7).hover();
    await bench.page.locator(".look", { hasText: /of 20 converged.*interval .* to .* %/ }).waitFor();
    await bench.page.mouse.move(0, 0);
    await bench.page.getByRole("group", { name: /Heat map/ }).focus();
    for (const key of ["ArrowRight", "ArrowRight", "ArrowDown"]) await bench.page.keyboard.press(key);
    await bench.page.locator(".heat tbody tr").nth(1).locator("td.looked").waitFor();
    assert.equal(await bench.page.locator(".heat td.looked").count(), 1);
  });
}
