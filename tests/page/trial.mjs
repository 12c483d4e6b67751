// A trial: its course, its player, its addresses.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, it } from "node:test";
import { openPage } from "./browser.mjs";

export function testTrial(bench) {
  let small;
  let failed;
  before(async () => {
    small = await bench.study("small");
    failed = await bench.failed();
    await bench.show(`#/studies/${small}/trials/${failed}`);
  });

  it("scrubs and plays a trial", async () => {
    const slider = bench.page.getByRole("slider", { name: "Time" });
    const link = bench.page.locator(".robot-body > g").last();
    const clock = bench.page.locator(".clock");
    const start = await link.getAttribute("transform");
    const trial = await bench.service.get(`v1/studies/${small}/trials/${failed}/view`);
    await slider.focus();
    await slider.press("End");
    assert.equal(await clock.innerText(), `${trial.trajectory.t.at(-1).toFixed(1)} s`);
    assert.notEqual(await link.getAttribute("transform"), start);
    const degrees = Number(/rotate\((\S+)\)/.exec(await link.getAttribute("transform"))[1]);
    assert.ok(Math.abs(degrees + (180 / Math.PI) * trial.trajectory.q2.at(-1)) < 0.01);
    await slider.press("Home");
    await bench.page.getByRole("button", { name: "Play" }).click();
    await bench.page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").value) > 0.3);
    await bench.page.getByRole("button", { name: "Pause" }).click();
    const stopped = await clock.innerText();
    await bench.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.equal(await clock.innerText(), stopped);
    await bench.page.getByRole("button", { name: "Next phase" }).click();
    assert.notEqual(await clock.innerText(), stopped);
  });

  it("zooms into a trial by two fingers, moves along it by one, and shows all again at a double tap", async () => {
    const phone = await openPage(bench.browser, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    await phone.page.goto(`${bench.service.url}#/studies/${small}/trials/${failed}?t=100`);
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
    const [download] = await Promise.all([bench.page.waitForEvent("download"), bench.page.getByRole("button", { name: "CSV of the trajectory" }).click()]);
    const lines = readFileSync(await download.path(), "utf8").trim().split("\n");
    const { trajectory } = await bench.service.get(`v1/studies/${small}/trials/${failed}/trajectory`);
    assert.equal(lines.length, trajectory.t.length + 1);
    const names = lines[0].split(",");
    const last = lines.at(-1).split(",");
    assert.equal(Number(last[names.indexOf("q2")]), trajectory.q2.at(-1));
  });

  it("is a link away for a colleague: the URL names the view", async () => {
    await bench.show(`#/studies/${small}/trials/${failed}?t=12.5`);
    await bench.page.waitForFunction(() => document.querySelector(".clock")?.value === "12.5 s");
  });

  it("shows of a trial with the robust policy where it brakes and what it aims at", async () => {
    const robust = await bench.study("robust");
    await bench.show(`#/studies/${robust}/trials/3`);
    await bench.page.getByText("where the policy brakes").waitFor();
    await bench.page.getByText("what the robust policy aims at").waitFor();
    assert.equal(await bench.page.getByText("Predicted (14), (15)").count(), 0, "that is what the paper's policy predicts");
  });
}
