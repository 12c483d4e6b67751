// Takes a picture of every view in light and dark, 1280 x 720 and 390 pixels wide, of the real service's own studies:
//
//   tests/page/run screenshots.mjs DIRECTORY [--vision DEFICIENCY] [PART-OF-A-NAME...]
//
// Whoever changes the page opens them. A picture is the whole length of its view, and named VIEW-THEME-WIDTH.png. With
// --vision protanopia, deuteranopia, tritanopia or achromatopsia it is what readers with that colour vision see.
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import { launch, openPage } from "./browser.mjs";
import { Service, runProgramBeside } from "./service.mjs";
import { shipped } from "./shipped.mjs";

const { values: { vision }, positionals: [directory, ...wanted] } = parseArgs({ allowPositionals: true, options: { vision: { type: "string", default: "none" } } });
if (!directory) throw new Error("say where the pictures go: tests/page/run screenshots.mjs DIRECTORY [--vision DEFICIENCY] [PART-OF-A-NAME...]");
const trials = (spec, count) => ({ ...spec, sampling: { ...spec.sampling, trials: count } });

const combined = shipped("robustness/combined");
const folder = mkdtempSync(join(tmpdir(), "steerstat-screenshots-"));
const service = new Service(join(folder, "data"));
mkdirSync(directory, { recursive: true });
await service.start();
const browser = await launch();

/** Each in every theme and width: what leads to a view, and what is there once it is drawn. */
async function picture(name, address, sign, prepare = async () => {}, finish = async () => {}) {
  if (wanted.length > 0 && !wanted.some((part) => name.includes(part))) return;
  for (const colorScheme of ["light", "dark"]) {
    for (const [width, height] of [[1280, 720], [390, 844]]) {
      const { page, context, faults } = await openPage(browser, { colorScheme, viewport: { width, height }, hasTouch: width < 600, isMobile: width < 600 });
      try {
        await (await context.newCDPSession(page)).send("Emulation.setEmulatedVisionDeficiency", { type: vision });
        await page.goto(address.startsWith("file:") ? address : service.url + address);
        await page.locator(sign).first().waitFor();
        await prepare(page);
        await page.evaluate(() => new Promise((done) => setTimeout(done, 350))); // charts follow the size of their card
        await page.screenshot({ path: join(directory, `${name}-${colorScheme}-${width}.png`), fullPage: true });
      } catch (error) {
        console.error(`${name}, ${colorScheme}, ${width}: ${error.message}`);
        process.exitCode = 1;
      }
      for (const fault of faults) console.error(`${name}, ${colorScheme}, ${width}: ${fault}`);
      await context.close();
      await finish();
    }
  }
}

/** Points at a chart, and clicks on what is there. */
async function hover(page, charts, k, isClicked = false) {
  const over = page.locator(charts).nth(k);
  await over.scrollIntoViewIfNeeded();
  const { width, height } = await over.boundingBox();
  const position = { x: 0.35 * width, y: 0.4 * height };
  await (isClicked ? over.click({ position }) : over.hover({ position }));
  if (isClicked) await page.locator(".look a").first().waitFor();
}

async function submit(spec) {
  const response = await fetch(`${service.url}v1/studies`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(spec) });
  if (!response.ok) throw new Error(await response.text());
  return (await response.json()).id;
}

/** @return the address of a study's report. The relay of the service goes on beside it */
async function report(name, spec) {
  const [file, result, html] = ["json", "h5", "html"].map((ending) => join(folder, `${name}.${ending}`));
  writeFileSync(file, JSON.stringify(spec));
  await runProgramBeside("run", file, "-o", result, "--no-progress");
  await runProgramBeside("report", result, "-o", html);
  return pathToFileURL(html).href;
}

try {
  await picture("studies-empty", "#/", ".empty");

  const small = await service.run({ ...trials(combined, 400), name: "small" });
  const other = await service.run({ ...trials(combined, 400), name: "small, contracting less", controller: { contraction: { eta2: 0.7 } } });
  const many = await service.run({ ...trials(combined, 60_000), name: "many" });
  const swept = await service.run(trials(shipped("parameter/eta"), 100));
  const gated = await service.run({ ...trials(shipped("nightly/friction"), 2000), name: "gated" });
  const failing = await service.run({ ...trials(combined, 300), name: "a gate of it fails", gates: [{ metric: "success_rate", expr: "ci_low >= 0.9" }, { metric: "settling_time", expr: "p95 < 250" }, { metric: "effort", expr: "max < 1e9" }] });
  const stopped = await service.run({ ...combined, name: "stopped", sampling: { ...combined.sampling, trials: 20_000 }, stop: { min_trials: 1000, check_every: 500, until: [{ metric: "success_rate", half_width: 0.03 }, { metric: "settling_time", quantile: 0.95, relative_half_width: 0.2 }] } });
  const sobol = await service.run({ ...trials(shipped("robustness/sensitivity"), 400), name: "sobol indices" });
  const listed = await service.run({ name: "listed", sampling: { method: "explicit", trials: [0.6, 0.8, 1, 1.2, 1.4].flatMap((m1) => [0, 0.02, 0.04].map((f2) => ({ "plant.m1": m1, "plant.f2": f2 }))) } });
  const dense = await service.run({ ...trials(shipped("parameter/eta"), 20), name: "many cells", controller: { contraction: { eta1: { sweep: Array.from({ length: 15 }, (_, k) => 0.3 + 0.03 * k) }, eta2: { sweep: Array.from({ length: 15 }, (_, k) => 0.4 + 0.03 * k) } }, swing: { period: { sweep: [1.5, 2] } } } });
  const robust = await service.run({ ...trials(combined, 100), name: "robust", controller: { policy: "robust" } });
  const paper = await service.run(shipped("paper/friction"));
  const view = await service.get(`v1/studies/${small}/view`);
  const failed = view.failed.index[0];
  const converged = view.sample.index.find((_, k) => view.sample.status[k] === 0);
  const chart = ".card canvas";

  await picture("new", "#/new", ".spec-form");
  await picture("new-open", "#/new", ".spec-form", async (page) => {
    await page.evaluate(() => document.querySelectorAll("details").forEach((each) => each.setAttribute("open", "")));
  });
  await picture("new-listed", "#/new", ".spec-form", (page) => page.getByLabel("Sampling: method").selectOption("explicit"));
  await picture("new-refused", "#/new", ".spec-form", async (page) => {
    await page.locator('[data-pointer="/plant/m1"]').getByLabel("low").fill("1.5");
    await page.locator('[data-pointer="/horizon"] input').fill("-1");
    await page.getByRole("button", { name: "Run the study" }).click();
    await page.locator("#refused").waitFor();
  });
  await picture("new-no-json", "#/new", ".spec-form", async (page) => {
    const json = page.getByLabel("Spec as JSON");
    await json.fill((await json.inputValue()).replace('"horizon": 300,', '"horizon": 300,,'));
    await page.getByText(/mistake in line \d+/).waitFor();
  });
  await picture("overview", `#/studies/${small}`, chart);
  await picture("overview-many", `#/studies/${many}`, chart);
  await picture("overview-swept", `#/studies/${swept}`, ".heat", async (page) => {
    await page.getByRole("group", { name: /Heat map/ }).focus();
    for (const key of ["ArrowRight", "ArrowDown"]) await page.keyboard.press(key);
  });
  await picture("overview-swept-time", `#/studies/${swept}`, ".heat", (page) => page.getByRole("button", { name: "Settling time" }).click());
  await picture("overview-dense", `#/studies/${dense}`, ".heat", async (page) => {
    await page.getByLabel("Across").selectOption({ label: "η₁" });
    await page.getByLabel("Up").selectOption({ label: "η₂" });
    await page.locator(".heat tbody td").nth(100).hover();
  });
  for (const [k, name] of ["narrowing", "distribution", "cycles"].entries()) await picture(`hover-${name}`, `#/studies/${small}`, chart, (page) => hover(page, ".overview .u-over", k));
  await picture("hover-map", `#/studies/${many}/why`, ".map-card canvas", (page) => hover(page, ".map-card .u-over", 0, true));
  await picture("hover-marginal", `#/studies/${small}/why`, ".small-multiples canvas", (page) => hover(page, ".small-multiples .u-over", 2));
  await picture("hover-trial", `#/studies/${small}/trials/${converged}`, ".figure-card canvas", (page) => hover(page, ".figure-card .u-over", 1));
  await picture("heavy-tail", `#/studies/${many}`, chart, (page) => page.locator(".overview select").first().selectOption("effort"));
  await picture("focus-map", `#/studies/${small}/why`, ".map-card canvas", async (page) => {
    await page.locator(".plane-keys").focus();
    for (let k = 0; k < 60; ++k) await page.keyboard.press("ArrowRight");
  });
  await picture("overview-gated", `#/studies/${gated}`, ".gates");
  await picture("overview-failing", `#/studies/${failing}`, ".gates");
  await picture("overview-stopped", `#/studies/${stopped}`, chart);
  await picture("overview-sobol", `#/studies/${sobol}`, chart);
  await picture("overview-one-trial", `#/studies/${paper}`, ".headline");
  await picture("overview-listed", `#/studies/${listed}`, chart);
  await picture("overview-all-converged", `#/studies/${robust}`, chart);
  await picture("why", `#/studies/${small}/why?x=plant.f2&y=initial_state.q2_dot`, ".map-card canvas");
  await picture("why-many", `#/studies/${many}/why`, ".map-card canvas");
  await picture("why-swept", `#/studies/${swept}/why`, ".map-card canvas");
  await picture("why-sobol", `#/studies/${sobol}/why`, ".map-card canvas");
  await picture("why-listed", `#/studies/${listed}/why`, ".map-card canvas");
  await picture("why-nothing-varies", `#/studies/${paper}/why`, ".empty, .card");
  await picture("trials", `#/studies/${small}/trials`, ".trial-table");
  await picture("trial-failed", `#/studies/${small}/trials/${failed}?t=12.5`, ".figure-card canvas");
  await picture("trial-converged", `#/studies/${small}/trials/${converged}?t=12.5`, ".figure-card canvas");
  await picture("trial-paper", `#/studies/${paper}/trials/0?t=12.5`, ".figure-card canvas");
  await picture("trial-robust", `#/studies/${robust}/trials/3?t=8`, ".figure-card canvas");
  await picture("compare", `#/compare?a=${small}&b=${other}`, ".pairs");
  await picture("compare-refused", `#/compare?a=${small}&b=${swept}`, ".problem");
  await picture("compare-choose", "#/compare", ".page");
  await picture("no-study", "#/studies/0000000000000000", ".empty");
  await picture("no-view", "#/elsewhere", ".empty");
  await picture("no-trial", `#/studies/${small}/trials/4000`, ".problem");

  const reported = await report("reported", { ...trials(combined, 20_000), name: "reported" });
  await picture("report", reported, ".headline");
  await picture("report-why", `${reported}#/studies/x/why`, ".page");
  await picture("report-trials", `${reported}#/studies/x/trials`, ".page");

  const rare = shipped("rare_failures/paper_corner_importance");
  const weighed = await service.run(rare);
  await picture("rare", `#/studies/${weighed}`, ".headline");
  await picture("rare-why", `#/studies/${weighed}/why`, ".map-card canvas");
  await picture("rare-levels", await report("levels", shipped("rare_failures/paper_corner_subset_simulation")), ".headline");
  const kept = await report("kept", { ...trials(combined, 20_000), name: "failures kept", store: "failed" });
  await picture("kept", kept, ".headline");
  await picture("kept-why", `${kept}#/studies/x/why`, ".map-card canvas");
  await picture("kept-none", await report("kept-none", { ...trials(combined, 20_000), name: "nothing kept", store: "summary" }), ".headline");

  const running = await submit({ ...trials(combined, 10_000_000), name: "a study under way, with a name that is longer than most" });
  const waiting = await submit({ ...trials(combined, 9_000_000), name: "waiting" });
  const cancelled = await submit({ ...trials(combined, 8_000_000), name: "cancelled" });
  await fetch(`${service.url}v1/studies/${cancelled}`, { method: "DELETE" });
  await picture("studies", "#/", ".study-table");
  await picture("overview-queued", `#/studies/${waiting}`, ".page-head .chip");
  await picture("overview-running", `#/studies/${running}`, ".headline .big");
  await picture("overview-cancelled", `#/studies/${cancelled}`, ".page-head .chip");
  await picture("lost", `#/studies/${running}`, ".headline .big", async (page) => {
    await service.kill();
    await page.getByText("No connection to the service").first().waitFor();
  }, () => service.start());
} finally {
  await browser.close();
  await service.kill();
  rmSync(folder, { recursive: true, force: true });
}
