// Drives the real service through the page, as a reader would.
//
//   STEERSTAT=build/ci/steerstat node --test page.test.mjs
import assert from "node:assert/strict";
import { after, before, describe } from "node:test";
import { testAccessibility } from "./accessible.mjs";
import { Bench } from "./bench.mjs";
import { testFollowing } from "./following.mjs";
import { testForm } from "./form.mjs";
import { testReport } from "./report.mjs";
import { testStudy } from "./study.mjs";
import { testTrial } from "./trial.mjs";

const bench = new Bench();

describe("The page", { concurrency: false }, () => {
  before(() => bench.open());
  after(async () => {
    await bench.close();
    assert.deepEqual(bench.faults, []);
  });
  describe("while studies run", () => testFollowing(bench));
  describe("with the form", () => testForm(bench));
  describe("of a study", () => testStudy(bench));
  describe("of a trial", () => testTrial(bench));
  describe("for everybody", () => testAccessibility(bench));
  describe("in a report", () => testReport(bench));
});
