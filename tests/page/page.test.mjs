// Drives the real service through the page, as a reader would.
//
//   STEERSTAT=build/ci/steerstat node --test page.test.mjs
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, describe, it } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { expectAccessible, launch, openPage, watchShifts } from "./browser.mjs";
import { Service, runProgram } from "./service.mjs";

const specs = process.env.SPECS ?? join(dirname(fileURLToPath(import.meta.url)), "../../studies/specs");
const combined = JSON.parse(readFileSync(join(specs, "robustness/combined.json"), "utf8"));
const swept = JSON.parse(readFileSync(join(specs, "parameter/eta.json"), "utf8"));

const folder = mkdtempSync(join(tmpdir(), "steerstat-page-"));
const service = new Service(join(folder, "data"));
let browser;

before(async () => {
  await service.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await service.kill();
  rmSync(folder, { recursive: true, force: true });
});

const chip = (page, text) => page.locator(".page-head .chip", { hasText: text });

describe("The page", { concurrency: false }, () => {
  let page;
  let faults;
  const ids = {};
  const show = async (fragment) => {
    await page.goto("about:blank");
    await page.goto(`${service.url}${fragment}`);
  };
  before(async () => ({ page, faults } = await openPage(browser)));
  after(() => assert.deepEqual(faults, []));

  it("sends a policy that allows nothing from elsewhere, and says so where there is no study", async () => {
    const response = await page.goto(service.url);
    const policy = response.headers()["content-security-policy"];
    assert.match(policy, /default-src 'none'/);
    assert.doesNotMatch(policy, /unsafe|https?:|\*/);
    await page.getByText("No study yet").waitFor();
  });

  it("shows a bad spec's mistake at its field, in its line and in a list that leads there", async () => {
    await show("#/");
    await page.getByRole("link", { name: "New study" }).first().click();
    await page.getByLabel("Start from").selectOption({ label: "combined" });
    const m1 = page.locator('[data-pointer="/plant/m1"]');
    await m1.getByLabel("low").fill("1.5");
    await page.getByRole("button", { name: "Run the study" }).click();
    await m1.locator(".mistakes", { hasText: "low < high" }).waitFor();
    assert.equal(await m1.getByLabel("low").getAttribute("aria-invalid"), "true");
    const text = await page.getByLabel("Spec as JSON").inputValue();
    const line = text.split("\n").findIndex((each) => each.includes('"m1"')) + 1;
    assert.equal(await page.locator(".editor-gutter .wrong").innerText(), String(line));
    await page.getByRole("button", { name: "/plant/m1" }).first().click();
    assert.equal(await page.evaluate(() => document.activeElement.closest("[data-pointer]").dataset.pointer), "/plant/m1");
    await expectAccessible(page, "a refused spec");
    await m1.getByLabel("low").fill("0.8");
    assert.equal(await page.locator(".mistakes").count(), 0);
  });

  it("keeps form and JSON one, and names the line of what is no JSON", async () => {
    const json = page.getByLabel("Spec as JSON");
    const text = await json.inputValue();
    assert.deepEqual(JSON.parse(text), combined);
    await json.fill(text.replace('"horizon": 300,', '"horizon": 300,,'));
    await page.getByText(/mistake in line \d+/).waitFor();
    assert.ok(await page.getByRole("button", { name: "Run the study" }).isDisabled());
    await json.fill(text.replace('"horizon": 300', '"horizon": 250'));
    assert.equal(await page.locator('[data-pointer="/horizon"] input').inputValue(), "250");
    await json.fill(text);
  });

  it("runs a study from the form and follows it to its end without anything jumping", async () => {
    await show("#/new");
    await page.locator('[data-pointer="/name"] input').fill("watched");
    await page.getByLabel("Trials", { exact: true }).fill("300000");
    await page.getByRole("button", { name: "Run the study" }).click();
    await page.getByRole("heading", { name: "watched" }).waitFor();
    ids.watched = /studies\/([0-9a-f]{16})/.exec(page.url())[1];
    const seen = new Set();
    const bar = page.locator(".head-progress [role=progressbar]");
    let shifts = null;
    for (const until = Date.now() + 240_000; Date.now() < until && (await chip(page, "done").count()) === 0; ) {
      const share = await bar.getAttribute("aria-valuenow", { timeout: 200 }).catch(() => null);
      if (share !== null) seen.add(Number(share));
      if (shifts === null && (await page.locator(".headline .big").count()) > 0) shifts = await watchShifts(page);
      await page.waitForTimeout(40);
    }
    await chip(page, "done").waitFor();
    await page.getByText("300,000 trials", { exact: true }).waitFor();
    assert.ok(seen.size >= 3, `progress was seen at ${[...seen].join(", ")} %`);
    if (shifts !== null) {
      const sum = await shifts();
      assert.ok(sum < 0.05, `what was in sight moved by ${sum}`);
    }
  });

  it("tells what the summary tells", async () => {
    await show(`#/studies/${ids.watched}`);
    const summary = await service.get(`v1/studies/${ids.watched}/summary`);
    assert.equal(summary.trials.completed, 300000);
    const share = Number((await page.locator(".headline .big").innerText()).replace(" %", ""));
    assert.ok(Math.abs(share - 100 * summary.success_rate.estimate) < 0.051);
    const converged = await page.locator(".outcomes tr", { hasText: "converged" }).locator("td").first().innerText();
    assert.equal(Number(converged.replace(/,/g, "")), summary.outcomes.converged);
  });

  it("maps the rates of very many trials, and lists the trials of a bin", async () => {
    await show(`#/studies/${ids.watched}`);
    await page.getByRole("link", { name: "Why it fails" }).click();
    await page.getByText("All 300,000 trials", { exact: false }).waitFor();
    const over = page.locator(".map-card .u-over");
    const box = await over.boundingBox();
    await over.click({ position: { x: box.width * 0.9, y: box.height * 0.8 } });
    const look = page.locator(".map-card .look");
    await look.getByText(/\d+ of \d+ converged/).waitFor();
    await page.getByLabel("Across").selectOption("plant.m1");
    await page.waitForURL(/x=plant\.m1/);
  });

  it("opens the very trial that failed and was clicked on the map", async () => {
    ids.small = await service.run({ ...combined, name: "small", sampling: { ...combined.sampling, trials: 300 } });
    await show(`#/studies/${ids.small}/why?x=plant.f2&y=initial_state.q2_dot`);
    const view = await service.get(`v1/studies/${ids.small}/view`);
    const column = (input) => view.sample.inputs[view.inputs.findIndex((each) => each.input === input)];
    const edges = (input) => view.marginals.find((each) => each.axis.input === input).axis.edges;
    const over = page.locator(".map-card .u-over");
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
    await page.getByRole("heading", { name: `Trial ${view.sample.index[loneliest]}`, exact: true }).waitFor();
    await page.locator(".facts .outcome").waitFor();
    assert.doesNotMatch(await page.locator(".facts .outcome").innerText(), /converged/);
    ids.failed = view.sample.index[loneliest];
  });

  it("scrubs and plays a trial", async () => {
    const slider = page.getByRole("slider", { name: "Time" });
    const link = page.locator(".robot-body > g").last();
    const clock = page.locator(".clock");
    const start = await link.getAttribute("transform");
    const trial = await service.get(`v1/studies/${ids.small}/trials/${ids.failed}/view`);
    await slider.focus();
    await slider.press("End");
    assert.equal(await clock.innerText(), `${trial.trajectory.t.at(-1).toFixed(1)} s`);
    assert.notEqual(await link.getAttribute("transform"), start);
    const degrees = Number(/rotate\((\S+)\)/.exec(await link.getAttribute("transform"))[1]);
    assert.ok(Math.abs(degrees + (180 / Math.PI) * trial.trajectory.q2.at(-1)) < 0.01);
    await slider.press("Home");
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").value) > 0.3);
    await page.getByRole("button", { name: "Pause" }).click();
    const stopped = await clock.innerText();
    await page.waitForTimeout(150);
    assert.equal(await clock.innerText(), stopped);
    await page.getByRole("button", { name: "Next phase" }).click();
    assert.notEqual(await clock.innerText(), stopped);
  });

  it("gives a trial's course as CSV, every digit of it", async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "CSV of the trajectory" }).click()]);
    const lines = readFileSync(await download.path(), "utf8").trim().split("\n");
    const { trajectory } = await service.get(`v1/studies/${ids.small}/trials/${ids.failed}/trajectory`);
    assert.equal(lines.length, trajectory.t.length + 1);
    const names = lines[0].split(",");
    const last = lines.at(-1).split(",");
    assert.equal(Number(last[names.indexOf("q2")]), trajectory.q2.at(-1));
  });

  it("is a link away for a colleague: the URL names the view", async () => {
    await show(`#/studies/${ids.small}/trials/${ids.failed}?t=12.5`);
    await page.waitForFunction(() => document.querySelector(".clock")?.value === "12.5 s");
  });

  it("opens a trial from the map by keyboard alone", async () => {
    await show(`#/studies/${ids.small}/why`);
    await page.locator(".plane-keys").focus();
    for (let k = 0; k < 5; ++k) await page.keyboard.press("ArrowRight");
    const told = await page.locator(".plane [aria-live]").innerText();
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { name: `Trial ${/trial ([\d,]+)/.exec(told)[1].replace(",", "")}`, exact: true }).waitFor();
  });

  it("compares two studies that are chosen in the list", async () => {
    ids.other = await service.run({ ...combined, name: "other", controller: { contraction: { eta2: 0.7 } }, sampling: { ...combined.sampling, trials: 300 } });
    await show("#/");
    await page.getByLabel("Choose small for a comparison").check();
    await page.getByLabel("Choose other for a comparison").check();
    await page.getByRole("button", { name: "Compare 2/2" }).click();
    const pairs = page.locator(".pairs .pair strong");
    await pairs.first().waitFor();
    const counts = (await pairs.allInnerTexts()).map(Number);
    assert.equal(counts.reduce((sum, n) => sum + n, 0), 300);
    await page.getByText("/controller/contraction/eta2").waitFor();
    const rows = page.locator("[aria-label='Discordant trials'] tbody tr");
    assert.equal(await rows.count(), Math.min(200, counts[1] + counts[2]));
  });

  it("shows sweeps as a heat map with each cell's interval", async () => {
    ids.swept = await service.run({ ...swept, sampling: { ...swept.sampling, trials: 20 } });
    await show(`#/studies/${ids.swept}`);
    const cells = page.locator(".heat tbody td");
    await cells.first().waitFor();
    assert.equal(await cells.count(), 25);
    await cells.nth(7).hover();
    await page.locator(".look", { hasText: /of 20 converged.*interval .* to .* %/ }).waitFor();
  });

  it("goes on by itself when the service is killed and comes back", async () => {
    const response = await fetch(`${service.url}v1/studies`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ ...combined, name: "long", sampling: { ...combined.sampling, trials: 5_000_000 } }) });
    assert.equal(response.status, 201);
    const { id } = await response.json();
    await show(`#/studies/${id}`);
    await page.locator(".headline .big").waitFor();
    await service.kill();
    await page.getByText("No connection to the service").first().waitFor();
    assert.equal(await page.locator(".headline .big").count(), 1, "what was last seen stays in sight");
    const completed = () => page.locator(".head-progress [role=progressbar]").getAttribute("aria-valuenow").then(Number);
    const before = await completed();
    await service.start();
    await page.locator(".connection[data-lost=false]").waitFor({ state: "attached" });
    await page.waitForFunction((share) => Number(document.querySelector(".head-progress [role=progressbar]")?.getAttribute("aria-valuenow")) > share, before, { timeout: 120_000 });
    await page.getByRole("button", { name: "Cancel long" }).click();
    await page.getByRole("button", { name: /Cancel it/ }).click();
    await chip(page, "cancelled").waitFor();
    await page.getByRole("link", { name: "Studies" }).first().click();
    await page.getByRole("link", { name: "long", exact: true }).waitFor();
  });

  it("deletes a study after asking back", async () => {
    await show("#/");
    await page.getByRole("button", { name: "Delete long" }).click();
    await page.getByRole("button", { name: /Delete it/ }).click();
    await page.getByRole("link", { name: "long", exact: true }).waitFor({ state: "detached" });
  });

  it("says so where a study or a view is not there", async () => {
    await show("#/studies/0000000000000000");
    await page.getByRole("heading", { name: "There is no such study" }).waitFor();
    await show("#/elsewhere");
    await page.getByRole("heading", { name: "There is no such view" }).waitFor();
  });

  for (const colorScheme of ["light", "dark"]) {
    for (const width of [1280, 390]) {
      it(`has nothing that axe finds serious, ${colorScheme}, ${width} pixels wide`, async () => {
        const other = await openPage(browser, { colorScheme, viewport: { width, height: 720 } });
        const views = {
          "#/": ".study-table",
          "#/new": ".spec-form",
          [`#/studies/${ids.small}`]: ".overview .chart canvas",
          [`#/studies/${ids.small}/why`]: ".map-card canvas",
          [`#/studies/${ids.small}/trials`]: ".trial-table",
          [`#/studies/${ids.small}/trials/${ids.failed}`]: ".figure-card canvas",
          [`#/studies/${ids.swept}`]: ".heat",
          [`#/compare?a=${ids.small}&b=${ids.other}`]: ".pairs",
        };
        for (const [fragment, sign] of Object.entries(views)) {
          await other.page.goto("about:blank");
          await other.page.goto(service.url + fragment);
          await other.page.locator(sign).first().waitFor();
          await expectAccessible(other.page, fragment);
        }
        assert.deepEqual(other.faults, []);
        await other.context.close();
      });
    }
  }

  it("is the same in a report, from a file and without a service", async () => {
    const result = join(folder, "small.h5");
    const html = join(folder, "small.html");
    const spec = join(folder, "small.json");
    const { writeFileSync } = await import("node:fs");
    writeFileSync(spec, JSON.stringify({ ...combined, name: "reported", sampling: { ...combined.sampling, trials: 300 } }));
    runProgram("run", spec, "-o", result, "--no-progress");
    runProgram("report", result, "-o", html);
    const report = await openPage(browser);
    const requests = [];
    report.page.on("request", (request) => requests.push(request.url()));
    await report.page.goto(pathToFileURL(html).href);
    await report.page.locator(".headline .big").waitFor();
    await report.page.getByRole("link", { name: "Trials", exact: true }).click();
    await report.page.getByLabel("Show").selectOption("failed");
    await report.page.locator(".trial-table tbody a").first().click();
    await report.page.locator(".robot svg").waitFor();
    assert.doesNotMatch(await report.page.locator(".facts .outcome").innerText(), /converged/);
    assert.deepEqual(requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), []);
    assert.deepEqual(report.faults, []);
    await report.context.close();
  });
});
