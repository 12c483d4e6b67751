// Reports: the same page from a file, with its data inside.
import assert from "node:assert/strict";
import { statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { it } from "node:test";
import { pathToFileURL } from "node:url";
import { combinedOf, importance } from "./bench.mjs";
import { openPage } from "./browser.mjs";
import { runProgram } from "./service.mjs";

export function testReport(bench) {
  it("is the same in a report, from a file and without a service", async () => {
    const result = join(bench.folder, "small.h5");
    const html = join(bench.folder, "small.html");
    const spec = join(bench.folder, "small.json");
    writeFileSync(spec, JSON.stringify(combinedOf("reported", 100_000)));
    runProgram("run", spec, "-o", result, "--no-progress");
    runProgram("report", result, "-o", html);
    assert.ok(statSync(html).size < 5_000_000, `a report of 100,000 trials has ${statSync(html).size} bytes`);
    const report = await openPage(bench.browser);
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

  it("tells in a report of weighed trials how rare failures are, and no rate along an input", async () => {
    const [spec, result, html] = ["json", "h5", "html"].map((ending) => join(bench.folder, `weighed.${ending}`));
    writeFileSync(spec, JSON.stringify({ ...importance, sampling: { ...importance.sampling, trials: 2000 } }));
    runProgram("run", spec, "-o", result, "--no-progress");
    runProgram("report", result, "-o", html);
    const { failure_rate: rate } = JSON.parse(runProgram("show", result, "--json").toString()).rare_failures;
    const report = await openPage(bench.browser);
    await report.page.goto(pathToFileURL(html).href);
    const [, mantissa, exponent] = /([\d.]+)×10⁻(.)/.exec(await report.page.locator(".headline .big").innerText());
    const shown = Number(mantissa) * 10 ** -"⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(exponent);
    assert.ok(Math.abs(shown / rate.estimate - 1) < 0.006, `${shown} is not ${rate.estimate}`);
    await report.page.locator(".headline .verdict", { hasText: "trusted" }).waitFor();
    await report.page.getByRole("link", { name: "Why it fails" }).click();
    await report.page.getByText("drawn where failures are sought").waitFor();
    assert.equal(await report.page.locator(".small-multiples, .bars, .rate-ramp").count(), 0);
    assert.deepEqual(report.faults, []);
    await report.context.close();
  });
}
