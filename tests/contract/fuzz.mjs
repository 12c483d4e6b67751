// Sends a real service what its own schemas make up, and that broken in every way: answers must be as /openapi.json
// describes them, none of them a 5xx, what is taken must be what the schema takes, and at the end the service must be well.
//
//   node fuzz.mjs STEERSTAT [SECONDS] [SEED]
//
// The same requests for the same SEED, as far as it comes in SECONDS (20; where STEERSTAT_NIGHTLY is 1, 300), 200 at least.
// Ends with the smallest request that it finds wrong.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import Ajv2020 from "ajv/dist/2020.js";
import fc from "fast-check";
import { generateSync } from "json-schema-faker";
import { answerCheck } from "./answers.mjs";

const nightly = process.env.STEERSTAT_NIGHTLY === "1";
const [program, seconds = nightly ? "300" : "20", seed = "1"] = process.argv.slice(2);
const directory = mkdtempSync(join(tmpdir(), "steerstat-fuzz-"));
const service = spawn(program, ["serve", "--port", "0", "--data", join(directory, "data"), "--threads", "2"]);
let told = "";
service.stderr.on("data", (text) => (told += text));
const ended = new Promise((resolve) => service.on("exit", (code, signal) => resolve(code ?? signal)));
const [ready] = await Promise.race([
  new Promise((resolve) => createInterface({ input: service.stdout }).once("line", (line) => resolve([line]))),
  ended.then((code) => { throw new Error(`the service ended with ${code}: ${told}`); }),
]);
const url = /http:\/\/[^/ ]+/.exec(ready)[0];

async function ask(method, path, body, headers = {}) {
  const answer = await fetch(url + path, { method, body, headers, signal: AbortSignal.timeout(120_000) });
  const type = (answer.headers.get("content-type") ?? "").split(";")[0];
  const content = type === "text/event-stream" ? (await answer.body.cancel(), "") : await answer.text();
  const isJson = type === "application/json" || type === "application/problem+json";
  return { method, path: path.split("?")[0], status: answer.status, type, headers: Object.fromEntries(answer.headers),
           body: isJson && content ? JSON.parse(content) : content };
}
const JSON_BODY = { "Content-Type": "application/json" };

const openapi = (await ask("GET", "/openapi.json")).body;
const schemas = {};
for (const name of ["study", "summary", "comparison", "view", "sensitivity", "approximation", "approximation_summary"]) {
  const { status, body } = await ask("GET", `/v1/schemas/${name}`);
  if (status === 200) schemas[`${name}.schema.json`] = body;
}
const check = answerCheck(openapi, schemas);
const studySchema = schemas["study.schema.json"];
const isStudy = new Ajv2020({ strict: false }).compile(studySchema);

// A finished study, that questions may be about.
const known = (await ask("POST", "/v1/studies", JSON.stringify({
  plant: { m1: { uniform: [0.8, 1.2] }, f2: { sweep: [0, 0.02] } }, horizon: 20, sampling: { trials: 40 } }), JSON_BODY)).body.id;
for (let status = ""; status !== "succeeded";) {
  status = (await ask("GET", `/v1/studies/${known}`)).body.status;
  if (status === "failed") throw new Error("the study to ask about has failed");
  await new Promise((resolve) => setTimeout(resolve, 20));
}

// A schema without alternatives: one branch of each, as `choose` says, since the generator would merge them all.
function oneBranch(schema, choose, depth = 0) {
  if (schema === null || typeof schema !== "object" || depth > 24) return schema;
  if (Array.isArray(schema)) return schema.map((each) => oneBranch(each, choose, depth + 1));
  const { $ref, anyOf, oneOf, allOf, if: condition, then, else: otherwise, not, description, default: usual, ...rest } = schema;
  let whole = rest;
  const join = (other) => (whole = { ...whole, ...other, properties: { ...whole.properties, ...other.properties } });
  if ($ref) join(oneBranch($ref.slice(2).split("/").reduce((value, key) => value[key], studySchema), choose, depth + 1));
  for (const branches of [anyOf, oneOf]) {
    if (branches) join(oneBranch(branches[choose(branches.length)], choose, depth + 1));
  }
  for (const [position, part] of (allOf ?? []).entries()) { // what it is, then what it is besides: of that its bounds
    const other = oneBranch(part, choose, depth + 1);
    join(position === 0 ? other : Object.fromEntries(Object.entries(other).filter(([key]) => /m(in|ax)imum$/i.test(key))));
  }
  if (whole.minProperties && whole.properties) { // so many of them, and no others
    const keys = Object.keys(whole.properties).filter((key) => !whole.required?.includes(key));
    const chosen = [...(whole.required ?? [])];
    while (chosen.length < whole.minProperties && keys.length) chosen.push(...keys.splice(choose(keys.length), 1));
    const properties = Object.fromEntries(chosen.map((key) => [key, whole.properties[key]]));
    whole = { ...whole, properties, required: chosen, minProperties: undefined, maxProperties: undefined };
  }
  for (const key of Object.keys(whole)) if (whole[key] === undefined) delete whole[key];
  if (Object.keys(whole.properties ?? {}).length === 0) delete whole.properties;
  return Object.fromEntries(Object.entries(whole).map(([key, value]) => [key, oneBranch(value, choose, depth + 1)]));
}

// A number generator of its own for each document, so that fast-check can repeat it.
function chooser(seed) {
  let state = seed >>> 0;
  return (count) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * count);
  };
}

// What a schema cannot say, so that more is taken and is over soon: bounds in their order, few trials, starts at speeds of
// this world (a link that spins a hundred times a second takes as many steps).
const most = { trials: 50, horizon: 30, initial_state: 4, plant: 4, first: 2, failed: 2, check_every: 1000 };
function orderly(value, key = "", bound = Infinity) {
  bound = most[key] ?? bound;
  if (Array.isArray(value)) {
    const each = value.map((one) => orderly(one, "", bound));
    return key === "uniform" || key === "triangular" ? each.sort((a, b) => a - b) : each;
  }
  if (typeof value === "number") return bound < Infinity && Math.abs(value) > bound ? (Number.isInteger(value) ? 1 + (value % bound) : value % bound) : value;
  if (value === null || typeof value !== "object") return value;
  const { low, high } = value;
  const ordered = low > high ? { ...value, low: high, high: low } : value;
  return Object.fromEntries(Object.entries(ordered).map(([name, one]) => [name, orderly(one, name, bound)]));
}

const specs = fc.record({ seed: fc.nat(), optional: fc.constantFrom(0.05, 0.15, 0.4) }).map(({ seed, optional }) => {
  const choose = chooser(seed);
  // Of a few documents the first that the schema takes: there are enough others.
  let spec = {};
  for (let attempt = 0; attempt < 4; ++attempt) {
    spec = orderly(generateSync(oneBranch(studySchema, choose), { seed: seed + attempt, optionalsProbability: optional, maxItems: 4, maxLength: 30 }));
    if (isStudy(spec)) break;
  }
  return spec;
});

const odd = fc.oneof(
  fc.constantFrom(null, true, "", "x", 0, -0, -1, 1e308, -1e308, 5e-324, 2 ** 53, 1e20, 0.1, [], {}, [[]], [null], "\u0000", "\ud800",
    "é".repeat(300), { uniform: [1, 0] }, { sweep: [1, 1] }, Array(3000).fill(1)),
  fc.double(), fc.integer(), fc.string(), fc.json().map((text) => JSON.parse(text)));

const change = fc.record({ at: fc.nat(), how: fc.constantFrom("replace", "remove", "rename", "wrap", "double"), value: odd });

function places(value, found = []) {
  if (value === null || typeof value !== "object") return found;
  for (const key of Object.keys(value)) {
    found.push([value, key]);
    places(value[key], found);
  }
  return found;
}

function changed(document, { at, how, value }) {
  const copy = structuredClone(document);
  const all = places(copy);
  if (all.length === 0) return value;
  const [holder, key] = all[at % all.length];
  if (how === "replace") holder[key] = value;
  if (how === "remove") Array.isArray(holder) ? holder.splice(Number(key), 1) : delete holder[key];
  if (how === "rename" && !Array.isArray(holder)) {
    holder[`${key}s`] = holder[key];
    delete holder[key];
  }
  if (how === "wrap") holder[key] = [holder[key]];
  if (how === "double") Array.isArray(holder) ? holder.push(holder[key]) : (holder[`${key} `] = holder[key]);
  return copy;
}

// A text, or one with bytes gone, or turned into others.
const damaged = (texts) => fc.tuple(texts, fc.array(fc.record({ at: fc.nat(), byte: fc.integer({ min: 0, max: 255 }), cut: fc.boolean() }), { maxLength: 3 }))
  .map(([text, damages]) => {
    let bytes = Buffer.from(text);
    for (const { at, byte, cut } of damages) {
      const place = at % (bytes.length + 1);
      bytes = cut ? Buffer.concat([bytes.subarray(0, place), bytes.subarray(place + 1)])
                  : Buffer.concat([bytes.subarray(0, place), Buffer.from([byte]), bytes.subarray(place + 1)]);
    }
    return bytes;
  });

const documents = (valid) => fc.oneof(
  { weight: 3, arbitrary: valid },
  { weight: 3, arbitrary: fc.tuple(valid, fc.array(change, { minLength: 1, maxLength: 3 })).map(([document, changes]) => changes.reduce(changed, document)) });
const bodies = (valid) => fc.oneof(
  { weight: 5, arbitrary: documents(valid).map((document) => Buffer.from(JSON.stringify(document) ?? "")) },
  { weight: 1, arbitrary: damaged(documents(valid).map((document) => JSON.stringify(document) ?? "")) },
  { weight: 1, arbitrary: fc.uint8Array({ maxLength: 300 }).map((bytes) => Buffer.from(bytes)) });

const text = fc.oneof(fc.string({ maxLength: 40 }), fc.string({ unit: "binary", maxLength: 20 }), fc.constantFrom("..", "%00", "/", "'", "0"));
const segment = text.map((value) => encodeURIComponent(value.toWellFormed?.() ?? value.replace(/[\ud800-\udfff]/g, "?")));
const ids = fc.oneof({ weight: 4, arbitrary: fc.constant(known) }, { weight: 1, arbitrary: fc.stringMatching(/^[a-z0-9]{1,34}$/) }, { weight: 1, arbitrary: segment });
const valueOf = (schema) => fc.nat().map((seed) => String(generateSync(schema, { seed })));

function resolved(value) {
  return value.$ref ? value.$ref.slice(2).split("/").reduce((at, key) => at[key], openapi) : value;
}
function withSchemas(schema) { // references inside of openapi.json, so that the generator knows them
  if (schema === null || typeof schema !== "object") return schema;
  if (schema.$ref?.startsWith("#/")) return withSchemas(resolved(schema));
  return Array.isArray(schema) ? schema.map(withSchemas) : Object.fromEntries(Object.entries(schema).map(([key, value]) => [key, withSchemas(value)]));
}

// A request of an operation, as its parameters and body are described, or not quite.
function requests(template, method, item) {
  const operation = item[method];
  const parameters = [...(item.parameters ?? []), ...(operation.parameters ?? [])].map(resolved);
  const from = (place) => parameters.filter((parameter) => parameter.in === place);
  const parts = Object.fromEntries(from("path").map(({ name, schema }) => [name, name === "id" ? ids
    : fc.oneof({ weight: 4, arbitrary: name === "name" ? fc.constantFrom("study", "summary") : fc.nat(90).map(String) },
               { weight: 1, arbitrary: valueOf(withSchemas(schema)).map(encodeURIComponent) }, { weight: 1, arbitrary: segment })
      .filter((part) => !/^(\.|%2e){1,2}$/i.test(part))])); // these a client resolves: it would ask for another path
  const names = { x: ["plant.m1", "plant.f2"], y: ["plant.f2", "plant.m1"] };
  const query = fc.record(Object.fromEntries(from("query").map(({ name, schema }) => [name, fc.oneof(
    { weight: 4, arbitrary: names[name] ? fc.constantFrom(...names[name]) : valueOf(withSchemas(schema)).map(encodeURIComponent) },
    { weight: 1, arbitrary: segment })])), { requiredKeys: [] });
  const surplus = fc.oneof({ weight: 12, arbitrary: fc.constant(null) }, { weight: 1, arbitrary: fc.tuple(segment, segment) });
  const tag = fc.constantFrom('"1"', "*", "", '"', `"${known}"`, 'W/"x", "y"');
  const headers = fc.record({
    Accept: fc.oneof({ weight: 12, arbitrary: fc.constantFrom("*/*", "text/html, */*;q=0.1") },
      { weight: 1, arbitrary: fc.constantFrom("application/xml", ";;,", "a/b;q=0", "application/json") }),
    "If-None-Match": tag, "If-Range": tag, Range: fc.constantFrom("bytes=0-7", "bytes=-1", "bytes=99999999-", "bytes=1-0", "lines=1-2", "bytes=0-1,3-4", "="),
    "Last-Event-ID": fc.constantFrom("0", "x", "18446744073709551616", "-1") }, { requiredKeys: [] });
  const isSubmission = template === "/v1/studies" && method === "post";
  const pairs = fc.record({ a: ids, b: ids });
  const body = operation.requestBody ? bodies(isSubmission ? specs : pairs) : fc.constant(undefined);
  return fc.record({ parts: fc.record(parts), query, surplus, headers, body,
                     type: fc.oneof({ weight: 12, arbitrary: fc.constant("application/json") }, { weight: 1, arbitrary: fc.constant("text/plain") }) })
    .map(({ parts, query, surplus, headers, body, type }) => {
      const path = template.replace(/{(\w+)}/g, (_, name) => parts[name]);
      const fields = Object.entries(query).map(([name, value]) => `${name}=${value}`);
      if (surplus) fields.push(`${surplus[0]}=${surplus[1]}`);
      return { method: method.toUpperCase(), path: path + (fields.length ? `?${fields.join("&")}` : ""), body,
               headers: body ? { ...headers, "Content-Type": type } : headers, isSubmission };
    });
}

const operations = Object.entries(openapi.paths).flatMap(([template, item]) =>
  ["get", "post"].filter((method) => item[method] && !item[method].tags.includes("models")) // each study that is taken is removed too, below
    .map((method) => ({ weight: template === "/v1/studies" && method === "post" ? 20 : 1, arbitrary: requests(template, method, item) })));

// Of UM-Bridge, 200 or 400.
const question = fc.record({
  name: fc.constantFrom("trial", "study", "none"),
  input: fc.array(fc.array(fc.double({ min: -0.3, max: 0.3, noNaN: true }), { maxLength: 5 }), { maxLength: 2 }),
  config: fc.oneof(fc.constant({}), fc.record({ inputs: fc.subarray(["plant.m1", "plant.f2", "initial_state.q2", "x"]) }),
    fc.record({ study: fc.oneof(fc.constant(known), odd) }), fc.record({ spec: fc.oneof(specs, odd) })) }, { requiredKeys: [] });
const models = fc.tuple(fc.constantFrom("/ModelInfo", "/InputSizes", "/OutputSizes", "/Evaluate", "/Gradient"), bodies(question))
  .map(([path, body]) => ({ method: "POST", path, body, headers: {}, isModel: true }));

const counts = {};
const slow = new Set(); // studies whose trials in flight take long
async function remove(id) { // a study that was taken; first it is cancelled
  for (let attempt = 0; attempt < 3; ++attempt) {
    const answer = await ask("DELETE", `/v1/studies/${id}`);
    const mistake = check(answer);
    if (mistake) return mistake;
    if (answer.status === 204 || answer.status === 404) return null;
    if (answer.status === 202) return void slow.add(id) ?? null;
  }
  return `${id} is not removed`;
}

async function mistakeOf({ method, path, body, headers, isSubmission, isModel }) {
  const answer = await ask(method, path, body, headers);
  const kind = isModel ? "model" : isSubmission ? "study" : "question";
  counts[`${kind} ${answer.status}`] = (counts[`${kind} ${answer.status}`] ?? 0) + 1;
  if (answer.status >= 500) return `${method} ${path} is answered ${answer.status}: ${JSON.stringify(answer.body)}`;
  if (isModel) {
    return [200, 400].includes(answer.status) ? check(answer) : `${path} is answered ${answer.status}`;
  }
  const mistake = check(answer);
  if (mistake) return mistake;
  if (!isSubmission || answer.status >= 300) return null;
  const id = answer.body.id;
  const mistakes = [];
  if (!isStudy(JSON.parse(body))) mistakes.push("a study is taken that its schema refuses");
  for (const place of ["", "/spec", "/summary", "/trials?limit=3"]) {
    const reply = await ask("GET", `/v1/studies/${id}${place}`);
    if (reply.status !== 200) mistakes.push(`${place} of a study that was taken is answered ${reply.status}`);
    mistakes.push(check(reply));
  }
  if (id !== known) mistakes.push(await remove(id));
  return mistakes.find((one) => one) ?? null;
}

let failure = null;
let requestsMade = 0;
try {
  const property = fc.asyncProperty(fc.oneof(...operations, { weight: 4, arbitrary: models }), async (request) => {
    const mistake = await mistakeOf(request);
    if (mistake) throw new Error(mistake);
  });
  const end = Date.now() + 1000 * Number(seconds);
  for (let part = 0; !failure && (Date.now() < end || requestsMade < 200); ++part) {
    const outcome = await fc.check(property, { seed: Number(seed) + 1000 * part, numRuns: 50 });
    requestsMade += outcome.numRuns;
    if (!outcome.failed) continue;
    const [request] = outcome.counterexample ?? [];
    failure = `${outcome.errorInstance?.stack ?? outcome.error}\n${JSON.stringify({ ...request, body: request?.body?.toString("latin1") })}`;
  }
  console.log(`seed ${seed}, ${requestsMade} requests:`, Object.entries(counts).sort().map(([kind, count]) => `${count} ${kind}`).join(", "), `${slow.size} of them slow`);
  for (const kind of ["study 201", "study 422", "study 400", "question 200", "question 400", "question 404", "model 200", "model 400"]) {
    if (!counts[kind]) failure ??= `there was no ${kind}: the requests are not what they are meant to be`;
  }
  if ((await ask("GET", "/healthz")).status !== 200) failure ??= "the service is not well";
  if ((await ask("GET", `/v1/studies/${known}/summary`)).body.complete !== true) failure ??= "the first study is gone";
} catch (problem) {
  failure ??= problem.stack;
}
service.kill("SIGTERM");
if (slow.size > 0) setTimeout(() => service.kill("SIGKILL"), 10_000).unref();
const code = await ended;
rmSync(directory, { recursive: true, force: true });
if (code !== 0 && !(code === "SIGKILL" && slow.size > 0)) failure ??= `the service ended with ${code}`;
if (/bug|internal error|renamed/.test(told)) failure ??= "the service tells of a bug";
if (failure) console.error(`${failure}\nThe service said:\n${told}`);
process.exitCode = failure ? 1 : 0;
