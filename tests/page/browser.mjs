// Debian's chromium, and what every page must keep to whatever is done with it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });

/** A page that notes what it must not do: fail in a script, break its policy, ask another host. */
export async function openPage(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  const faults = [];
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("console", (message) => {
    // What a request was answered is the test's own business; a script that failed or broke the policy is not.
    if (message.type() === "error" && !message.text().startsWith("Failed to load resource")) faults.push(message.text());
  });
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (!["127.0.0.1", "localhost", ""].includes(url.hostname)) faults.push(`asked ${url}`);
  });
  return { page, context, faults };
}

/** Nothing that axe finds serious; and nothing wider than the screen. @param rules  of axe; all, unless some are named */
export async function expectAccessible(page, name, rules = null) {
  await page.evaluate(axe);
  const only = rules === null ? {} : { runOnly: { type: "rule", values: rules } };
  const { violations } = await page.evaluate((more) => globalThis.axe.run(document, { resultTypes: ["violations"], ...more }), only);
  const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  assert.deepEqual(serious.map(({ id, nodes }) => `${name}: ${id} at ${nodes[0].target.join(" ")}: ${nodes[0].failureSummary}`), []);
  const surplus = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(surplus <= 0, `${name} is wider than its screen by ${surplus} pixels`);
}

/** How far what was in sight has moved on its own, summed up since the page was loaded. */
export async function watchShifts(page) {
  await page.evaluate(() => {
    globalThis.shifts = 0;
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) if (!entry.hadRecentInput) globalThis.shifts += entry.value;
    }).observe({ type: "layout-shift", buffered: false });
  });
  return () => page.evaluate(() => globalThis.shifts);
}
