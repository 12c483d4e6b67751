// Measures how long it takes from the address to what one came for, in a browser that knows nothing yet:
//
//   tests/page/run measure.mjs
//
// a list of 200 studies, and a study of a million trials, whose view is made when it is first asked for. On an idle
// machine; nothing here fails for being slow.
import { Bench, combinedOf } from "./bench.mjs";
import { openPage } from "./browser.mjs";

const bench = new Bench();

/** From the beginning of the navigation to the frame after `sign` is there [s]. */
async function until(fragment, sign) {
  const { page, context } = await openPage(bench.browser);
  page.setDefaultTimeout(120_000);
  await page.addInitScript((wanted) => {
    const look = () => (document.querySelector(wanted) ? requestAnimationFrame(() => (globalThis.there = performance.now())) : requestAnimationFrame(look));
    look();
  }, sign);
  await page.goto(bench.service.url + fragment);
  await page.waitForFunction(() => globalThis.there !== undefined);
  const seconds = (await page.evaluate(() => globalThis.there)) / 1000;
  await context.close();
  return seconds;
}

const told = (all) => `${all.map((each) => each.toFixed(2)).join(", ")} s`;

async function times(repeats, fragment, sign, prepare = async () => {}) {
  const all = [];
  for (let k = 0; k < repeats; ++k) {
    await prepare();
    all.push(await until(fragment, sign));
  }
  return told(all);
}

async function again() {
  await bench.service.kill("SIGTERM");
  await bench.service.start();
}

try {
  await bench.open();
  for (let seed = 1; seed <= 200; ++seed) {
    const spec = combinedOf(`study ${seed}`, 20);
    await bench.service.run({ ...spec, sampling: { ...spec.sampling, seed }, audit: { trials: 0 } });
  }
  console.log(`a list of 200 studies:                    ${await times(5, "#/", ".study-table tbody tr")}`);
  const million = await bench.service.run(combinedOf("million", 1_000_000));
  await bench.service.get("healthz");
  const overview = [`#/studies/${million}`, ".overview .chart canvas"];
  console.log(`a million trials, after a restart:        ${await times(5, ...overview, again)}`);
  console.log(`the same again:                           ${await times(5, ...overview)}`);
  console.log(`their map of two inputs, after a restart: ${await times(3, `#/studies/${million}/why`, ".map-card canvas", again)}`);
} finally {
  await bench.close();
}
