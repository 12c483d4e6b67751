// What axe finds, in every view, theme and width.
import assert from "node:assert/strict";
import { it } from "node:test";
import { expectAccessible, openPage } from "./browser.mjs";

export function testAccessibility(bench) {
  it("has nothing that axe finds serious in any view, light or dark, wide or narrow", async () => {
    // Tables of few rows: axe takes its time with each, and they are all alike.
    const [small, few, fewOthers, swept, robust] = await Promise.all(["small", "few", "fewOthers", "swept", "robust"].map((name) => bench.study(name)));
    const views = {
      "#/": ".study-table",
      "#/new": ".spec-form",
      [`#/studies/${small}`]: ".overview .chart canvas",
      [`#/studies/${small}/why`]: ".map-card canvas",
      [`#/studies/${robust}/trials`]: ".trial-table",
      [`#/studies/${small}/trials/${await bench.failed()}`]: ".figure-card canvas",
      [`#/studies/${swept}`]: ".heat",
      [`#/studies/${robust}/trials/3`]: ".figure-card canvas",
      [`#/compare?a=${few}&b=${fewOthers}`]: ".pairs",
    };
    // The wide page and the narrow one side by side. Nothing but colours depends on the theme.
    await Promise.all([1280, 390].map(async (width) => {
      const { page, context, faults } = await openPage(bench.browser, { viewport: { width, height: 720 } });
      for (const [fragment, sign] of Object.entries(views)) {
        await page.emulateMedia({ colorScheme: "light" });
        await page.goto("about:blank");
        await page.goto(bench.service.url + fragment);
        await page.locator(sign).first().waitFor();
        await expectAccessible(page, `${fragment}, light, ${width}`);
        await page.emulateMedia({ colorScheme: "dark" });
        await expectAccessible(page, `${fragment}, dark, ${width}`, ["color-contrast"]);
      }
      assert.deepEqual(faults, []);
      await context.close();
    }));
  });
}
