// Drives the real service through the page, as a reader would.
//
//   STEERSTAT=build/ci/steerstat node --test page.test.mjs
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
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

/** So many trials of combined.json as this machine runs in so many seconds, whatever machine it is. */
let trialsIn = () => 0;

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
  const settled = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
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

  it("has fields for stopping rules and correlations, whose mistakes stand at their rows", async () => {
    await show("#/new");
    const json = page.getByLabel("Spec as JSON");
    const spec = async () => JSON.parse(await json.inputValue());
    await page.locator("summary", { hasText: "When to stop" }).click();
    await page.getByRole("button", { name: "Add a goal" }).click();
    await page.getByLabel("Goal 1: metric").selectOption("settling_time");
    await page.getByLabel("Goal 1: kind of width").selectOption("relative_half_width");
    const goal = page.locator('[data-pointer="/stop/until/0"]');
    await goal.getByLabel("quantile").fill("0.9");
    await goal.getByLabel("at most").fill("0.05");
    await page.locator('[data-pointer="/stop/check_every"] input').fill("500");
    assert.deepEqual((await spec()).stop, { until: [{ metric: "settling_time", quantile: 0.9, relative_half_width: 0.05 }], check_every: 500 });
    await page.locator("summary", { hasText: "Correlations" }).click();
    await page.getByRole("button", { name: "Add a correlation" }).click();
    const pair = page.locator('[data-pointer="/sampling/correlation/0"]');
    await pair.getByLabel("Correlation 1: other input").selectOption("plant.f2");
    await pair.getByLabel("correlation", { exact: true }).fill("1.5");
    assert.deepEqual((await spec()).sampling.correlation, [["plant.m1", "plant.f2", 1.5]]);
    await page.getByRole("button", { name: "Run the study" }).click();
    await pair.locator(".mistakes").waitFor();
    await expectAccessible(page, "a refused correlation");
    await page.getByRole("button", { name: "Take correlation 1 away" }).click();
    await page.getByRole("button", { name: "Take goal 1 away" }).click();
    assert.deepEqual(await spec(), combined);
  });

  it("runs a study from the form and follows it to its end without anything jumping", async () => {
    const probe = await service.run({ ...combined, name: "probe", sampling: { ...combined.sampling, trials: 20000, seed: 2 } });
    const { trials_per_s: rate } = (await service.get(`v1/studies/${probe}/summary`)).performance;
    trialsIn = (seconds) => Math.min(10_000_000, Math.max(20_000, 1000 * Math.round((seconds * rate) / 1000)));
    // Longer, where the machine turns out to be quicker than it was a moment ago.
    let seen = [];
    for (let seconds = 8; seen.length < 3 && seconds < 1000; seconds *= 4) seen = await watch(trialsIn(seconds));
    assert.ok(seen.length >= 3, `progress was seen at ${seen.join(", ")} %`);
  });

  /** Runs a study from the form. @return the shares of its progress that were in sight [%] */
  async function watch(trials) {
    ids.watchedTrials = trials;
    await show("#/new");
    await page.locator('[data-pointer="/name"] input').fill(`watched ${trials}`);
    await page.getByLabel("Trials", { exact: true }).fill(String(trials));
    await page.evaluate(() => {
      globalThis.seen = new Set();
      const look = () => globalThis.seen.add(document.querySelector(".head-progress [role=progressbar]")?.getAttribute("aria-valuenow") ?? "");
      new MutationObserver(look).observe(document.body, { subtree: true, childList: true, attributes: true });
    });
    await page.getByRole("button", { name: "Run the study" }).click();
    await page.getByRole("heading", { name: `watched ${trials}` }).waitFor();
    ids.watched = /studies\/([0-9a-f]{16})/.exec(page.url())[1];
    await page.locator(".headline .big").waitFor();
    const shifts = await watchShifts(page);
    await chip(page, "done").waitFor({ timeout: 240_000 });
    await page.getByText(`${trials.toLocaleString("en")} trials`, { exact: true }).waitFor();
    const sum = await shifts();
    assert.ok(sum < 0.05, `what was in sight moved by ${sum}`);
    return (await page.evaluate(() => [...globalThis.seen])).filter((share) => share !== "");
  }

  it("tells what the summary tells", async () => {
    await show(`#/studies/${ids.watched}`);
    const summary = await service.get(`v1/studies/${ids.watched}/summary`);
    assert.equal(summary.trials.completed, ids.watchedTrials);
    const share = Number((await page.locator(".headline .big").innerText()).replace(" %", ""));
    assert.ok(Math.abs(share - 100 * summary.success_rate.estimate) < 0.051);
    const converged = await page.locator(".outcomes tr", { hasText: "converged" }).locator("td").first().innerText();
    assert.equal(Number(converged.replace(/,/g, "")), summary.outcomes.converged);
  });

  it("maps the rates of very many trials, and lists the trials of a bin", async () => {
    await show(`#/studies/${ids.watched}`);
    await page.getByRole("link", { name: "Why it fails" }).click();
    await page.getByText(`All ${ids.watchedTrials.toLocaleString("en")} trials`, { exact: false }).waitFor();
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
    await settled();
    assert.equal(await clock.innerText(), stopped);
    await page.getByRole("button", { name: "Next phase" }).click();
    assert.notEqual(await clock.innerText(), stopped);
  });

  it("zooms into a trial by two fingers, moves along it by one, and shows all again at a double tap", async () => {
    const phone = await openPage(browser, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    await phone.page.goto(`${service.url}#/studies/${ids.small}/trials/${ids.failed}?t=100`);
    const over = phone.page.locator(".figure-card .u-over").first();
    await over.waitFor();
    await over.scrollIntoViewIfNeeded();
    const box = await over.boundingBox();
    const fingers = await phone.context.newCDPSession(phone.page);
    const y = box.y + box.height / 2;
    const touch = (type, ...shares) => fingers.send("Input.dispatchTouchEvent", { type, touchPoints: shares.map((share, id) => ({ x: box.x + share * box.width, y, id })) });
    const heads = () => phone.page.locator(".playhead").evaluateAll((all) => all.map((each) => (each.hidden ? "hidden" : each.style.transform)));
    const whole = await heads();
    assert.equal(whole.length, 6);
    await touch("touchStart", 0.4, 0.6);
    await touch("touchMove", 0.2, 0.8);
    await touch("touchEnd");
    await phone.page.waitForFunction((before) => document.querySelector(".playhead").style.transform !== before, whole[0]);
    const zoomed = await heads();
    assert.equal(new Set(zoomed).size, 1, "every chart over time shows the same");
    await touch("touchStart", 0.3);
    await touch("touchMove", 0.5);
    await touch("touchEnd");
    await phone.page.waitForFunction((before) => document.querySelector(".playhead").style.transform !== before, zoomed[0]);
    await over.tap();
    await over.dblclick();
    await phone.page.waitForFunction(() => [...document.querySelectorAll(".playhead")].every((each) => !each.hidden));
    assert.deepEqual(phone.faults, []);
    await phone.context.close();
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

  it("shows of a trial with the robust policy where it brakes and what it aims at", async () => {
    ids.robust = await service.run({ ...combined, name: "robust", controller: { policy: "robust" }, sampling: { ...combined.sampling, trials: 20 } });
    await show(`#/studies/${ids.robust}/trials/3`);
    await page.getByText("where the policy brakes").waitFor();
    await page.getByText("what the robust policy aims at").waitFor();
    assert.equal(await page.getByText("Predicted (14), (15)").count(), 0, "that is what the paper's policy predicts");
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
    await page.mouse.move(0, 0);
    await page.getByRole("group", { name: /Heat map/ }).focus();
    for (const key of ["ArrowRight", "ArrowRight", "ArrowDown"]) await page.keyboard.press(key);
    await page.locator(".heat tbody tr").nth(1).locator("td.looked").waitFor();
    assert.equal(await page.locator(".heat td.looked").count(), 1);
  });

  it("goes on by itself when the service is killed and comes back", async () => {
    const response = await fetch(`${service.url}v1/studies`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ ...combined, name: "long", sampling: { ...combined.sampling, trials: trialsIn(90) } }) });
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
          [`#/studies/${ids.robust}/trials/3`]: ".figure-card canvas",
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
    writeFileSync(spec, JSON.stringify({ ...combined, name: "reported", sampling: { ...combined.sampling, trials: 100_000 } }));
    runProgram("run", spec, "-o", result, "--no-progress");
    runProgram("report", result, "-o", html);
    assert.ok(statSync(html).size < 5_000_000, `a report of 100,000 trials has ${statSync(html).size} bytes`);
    const report = await openPage(browser);
    const requests = [];
    report.page.on("request", (request) => requests.push(request.url()));
    await report.page.goto(pathToFileURL(html).href);
    await report.page.locator(".headline .big").waitFor();
    await report.page.getByRole("link", { name: "Why it fails" }).click();
    await report.page.getByText("All 100,000 trials").waitFor();
    await report.page.getByRole("button", { name: "Trials", exact: true }).click();
    await report.page.getByText("10,000 of 100,000 trials, chosen at random").waitFor();
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
