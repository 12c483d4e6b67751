// What the page's tests share: one service, one browser, one page, and a few small studies, each run when first asked for.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, openPage } from "./browser.mjs";
import { Service } from "./service.mjs";
import { shipped } from "./shipped.mjs";

export const combined = shipped("robustness/combined");
export const importance = shipped("rare_failures/paper_corner_importance");
const swept = shipped("parameter/eta");

/** combined.json with so many trials, and whatever else. */
export const combinedOf = (name, trials, more = {}) => ({ ...combined, name, sampling: { ...combined.sampling, trials }, ...more });

const studies = {
  small: combinedOf("small", 300),
  other: combinedOf("other", 300, { controller: { contraction: { eta2: 0.7 } } }),
  few: combinedOf("few", 40),
  fewOthers: combinedOf("few others", 40, { controller: { contraction: { eta2: 0.7 } } }),
  many: combinedOf("many", 30_000),
  robust: combinedOf("robust", 20, { controller: { policy: "robust" } }),
  swept: { ...swept, sampling: { ...swept.sampling, trials: 20 } },
};

export class Bench {
  #ids = new Map();
  folder = mkdtempSync(join(tmpdir(), "steerstat-page-"));
  service = new Service(join(this.folder, "data"));

  async open() {
    await this.service.start();
    this.browser = await launch();
    Object.assign(this, await openPage(this.browser));
  }

  async close() {
    await this.browser?.close();
    await this.service.kill();
    rmSync(this.folder, { recursive: true, force: true });
  }

  async show(fragment) {
    await this.page.goto("about:blank");
    await this.page.goto(`${this.service.url}${fragment}`);
  }

  /** The id of one of the studies above. */
  async study(name) {
    if (!this.#ids.has(name)) this.#ids.set(name, await this.service.run(studies[name]));
    return this.#ids.get(name);
  }

  /** A trial of `small` that did not converge. */
  async failed() {
    return (await this.service.get(`v1/studies/${await this.study("small")}/view`)).failed.index[0];
  }

  /** So many trials of combined.json as this machine runs in so many seconds, whatever machine it is. */
  async trialsIn(seconds) {
    if (!this.rate) {
      const probe = await this.service.run(combinedOf("probe", 20_000));
      this.rate = (await this.service.get(`v1/studies/${probe}/summary`)).performance.trials_per_s;
    }
    return Math.min(10_000_000, Math.max(20_000, 1000 * Math.round((seconds * this.rate) / 1000)));
  }
}
