// The program under the page: starts it, asks it, kills it.
import { execFile, execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { createInterface } from "node:readline";
import { promisify } from "node:util";
import { relayTo } from "./relay.mjs";

const program = process.env.STEERSTAT;

export class Service {
  #process = null;
  #port = "0";
  #relay = null; // the page asks it, so that every answer is noted
  url = "";

  constructor(data) {
    this.data = data;
  }

  /** Returns once it says that it serves: at a free port, after a kill at the same one. */
  async start() {
    this.#process = spawn(program, ["serve", "--port", this.#port, "--data", this.data], { stdio: ["ignore", "pipe", "inherit"] });
    for await (const line of createInterface({ input: this.#process.stdout })) {
      const found = /http:\/\/\S+/.exec(line);
      if (found) {
        this.#port = new URL(found[0]).port;
        await this.#openRelay();
        return;
      }
    }
    throw new Error("the service ended before it served");
  }

  async #openRelay() {
    if (this.#relay !== null) return;
    this.#relay = relayTo(() => this.#port);
    this.#relay.listen(0, "127.0.0.1");
    await once(this.#relay, "listening");
    this.#relay.unref();
    this.url = `http://127.0.0.1:${this.#relay.address().port}/`;
  }

  async kill(signal = "SIGKILL") {
    const process = this.#process;
    if (process === null || process.exitCode !== null || process.signalCode !== null) return;
    process.kill(signal);
    await once(process, "exit");
  }

  async get(path) {
    const response = await fetch(this.url + path);
    if (!response.ok) throw new Error(`${path}: ${response.status} ${await response.text()}`);
    return response.json();
  }

  /** Submits a spec and waits until it is done. */
  async run(spec) {
    const response = await fetch(`${this.url}v1/studies`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(spec) });
    if (!response.ok) throw new Error(await response.text());
    const { id } = await response.json();
    for (;;) {
      const { status, failure } = await this.get(`v1/studies/${id}`);
      if (status === "succeeded") return id;
      if (status !== "queued" && status !== "running") throw new Error(`${spec.name}: ${status} ${failure}`);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }
}

export const runProgram = (...words) => execFileSync(program, words, { stdio: ["ignore", "pipe", "inherit"] });

export const runProgramBeside = (...words) => promisify(execFile)(program, words);
