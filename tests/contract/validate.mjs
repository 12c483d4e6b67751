// Holds JSON documents against the schemas, with ajv.
//
//   node validate.mjs specs SCHEMA SPECS CORPUS     shipped specs and the corpus' verdicts
//   node validate.mjs approximations SCHEMA SPECS CORPUS     the same for approximation studies
//   node validate.mjs summaries SCHEMA SUMMARY...   summaries pass, and every broken copy of one is refused
//   node validate.mjs exchanges SESSION     a service's answers, each against what its own /openapi.json says of it
//   node validate.mjs answers SESSION DIRECTORY     the same of those that tests noted there
//
// Exits 1 after naming every document with the wrong verdict, and where there was nothing to check.
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import Ajv2020 from "ajv/dist/2020.js";
import { answerCheck, asNoted } from "./answers.mjs";

const read = (path) => JSON.parse(readFileSync(path, "utf8"));

function compile(schemaPath) {
  // Strict: a misspelt keyword in the schema is an error. Types are stated beside `properties`, not in each branch.
  const ajv = new Ajv2020({ allErrors: true, strict: true, strictTypes: false, strictRequired: false });
  for (const other of jsonFilesUnder(dirname(schemaPath))) {
    if (other !== schemaPath) ajv.addSchema(read(other)); // what it may refer to
  }
  const validate = ajv.compile(read(schemaPath));
  return (document) => ({ valid: validate(document), why: ajv.errorsText(validate.errors, { separator: "\n    " }) });
}

function jsonFilesUnder(directory) {
  const files = readdirSync(directory, { recursive: true }).map(String);
  const isSpec = (name) => name.endsWith(".json") && !name.endsWith(".summary.json"); // baselines lie among the specs
  return files.filter(isSpec).sort().map((name) => join(directory, name));
}

let checks = 0;
const mistakes = [];

function expectVerdict(check, document, valid, name) {
  checks += 1;
  const verdict = check(document);
  if (verdict.valid !== valid) {
    mistakes.push(valid ? `${name} is refused:\n    ${verdict.why}` : `${name} is accepted, and must not be`);
  }
}

function expectVerdicts(check, directory, valid, isMeant = () => true) {
  const files = jsonFilesUnder(directory).filter((file) => isMeant(read(file)));
  if (files.length === 0) mistakes.push(`there is no document in ${directory}`);
  for (const file of files) expectVerdict(check, read(file), valid, file);
}

// Copies of a document, each with one key gone, one key too many, or one value of another type.
function* brokenCopies(document) {
  function* places(value, path) {
    if (value === null || typeof value !== "object") return;
    yield path;
    for (const key of Object.keys(value)) yield* places(value[key], [...path, key]);
  }
  const at = (root, path) => path.reduce((value, key) => value[key], root);
  for (const path of places(document, [])) {
    const original = at(document, path);
    if (Array.isArray(original)) continue;
    const isSweep = ["sweep", "cell"].includes(path.at(-1)); // its keys are the study's
    for (const key of Object.keys(original)) {
      const where = [...path, key].join("/");
      for (const [change, apply] of [
        ["gone", (object) => delete object[key]],
        ["a wrong type", (object) => (object[key] = [true])],
      ]) {
        if (isSweep && change === "gone" && Object.keys(original).length > 1) continue;
        const copy = structuredClone(document);
        apply(at(copy, path));
        yield [`${where} ${change}`, copy];
      }
    }
    const copy = structuredClone(document);
    at(copy, path).surplus = isSweep ? "not a number" : 1;
    yield [`${path.join("/")} with a surplus key`, copy];
  }
}

const isApproximation = (spec) => spec.kind === "approximation";

function checkSpecs([schema, specs, corpus], isMeant = (spec) => !isApproximation(spec)) {
  const check = compile(schema);
  expectVerdicts(check, specs, true, isMeant);
  expectVerdicts(check, join(corpus, "good"), true);
  expectVerdicts(check, join(corpus, "bad"), false);
}

function checkSummaries([schema, ...files]) {
  const check = compile(schema);
  if (files.length === 0) mistakes.push("no summary was given");
  for (const file of files) {
    const summary = read(file);
    expectVerdict(check, summary, true, file);
    for (const [change, copy] of brokenCopies(summary)) expectVerdict(check, copy, false, `${file}, ${change},`);
  }
}

function checkExchanges([session]) {
  const { openapi, schemas, exchanges } = read(session);
  const check = answerCheck(openapi, schemas);
  const seen = new Set();
  for (const exchange of exchanges) {
    checks += 1;
    const mistake = check(exchange);
    if (mistake) mistakes.push(mistake);
    seen.add(check.described);
  }
  const operations = Object.entries(openapi.paths).flatMap(([path, item]) =>
    ["get", "post", "delete"].filter((method) => item[method]).map((method) => `${path} ${method}`));
  for (const operation of operations) {
    const [path, method] = operation.split(" ");
    const described = Object.keys(openapi.paths[path][method].responses);
    const isOptional = described.includes("404") && !path.includes("{"); // a program without the page is one
    if (described.some((status) => status < 300) && !isOptional && ![...seen].some((key) => key?.startsWith(`${operation} 2`))) mistakes.push(`${operation} was never answered well`);
  }
}

// Of an answer, copies that the check must refuse: of another status, type or body, or without a header that it needs.
function* brokenAnswers(exchange) {
  yield ["of another status", { ...exchange, status: 299 }];
  yield ["of another type", { ...exchange, type: "text/x-other" }];
  if (exchange.type.endsWith("json") && exchange.method !== "HEAD") {
    yield ["with another body", { ...exchange, body: [true] }];
    if (exchange.type === "application/problem+json") {
      for (const key of ["type", "title", "status", "detail"]) yield [`without ${key}`, { ...exchange, body: { ...exchange.body, [key]: undefined } }];
    }
  }
  const needed = { 201: "location", 206: "content-range", 304: "etag", 401: "www-authenticate", 405: "allow", 503: "retry-after" }[exchange.status];
  if (needed) yield [`without ${needed}`, { ...exchange, headers: { ...exchange.headers, [needed]: undefined } }];
}

function checkAnswers([session, directory]) {
  const { openapi, schemas } = read(session);
  const check = answerCheck(openapi, schemas);
  const counts = new Map();
  const files = readdirSync(directory).filter((name) => name.endsWith(".jsonl"));
  for (const kind of ["raw", "python", "relay"]) { // tests that speak to sockets, through Python, and others' clients
    if (!files.some((name) => name.startsWith(kind))) mistakes.push(`no test noted its answers in ${directory}/${kind}-*`);
  }
  for (const file of files) {
    for (const line of readFileSync(join(directory, file), "utf8").split("\n").filter(Boolean)) {
      const exchange = asNoted(JSON.parse(line));
      checks += 1;
      const mistake = check(exchange);
      if (mistake) {
        mistakes.push(`${file}: ${mistake}`);
        continue;
      }
      const kind = `${exchange.answerer} ${exchange.type} ${check.described}`;
      counts.set(kind, (counts.get(kind) ?? 0) + 1);
      if (counts.get(kind) > 1) continue;
      for (const [change, copy] of brokenAnswers(exchange)) {
        checks += 1;
        if (!check(copy)) mistakes.push(`${file}: ${kind} ${change} is accepted, and must not be`);
      }
    }
  }
  for (const [kind, count] of [...counts].sort()) console.log(`${count} ${kind}`);
}

const [mode, ...rest] = process.argv.slice(2);
const checkApproximations = (files) => checkSpecs(files, isApproximation);
({ specs: checkSpecs, approximations: checkApproximations, summaries: checkSummaries, exchanges: checkExchanges, answers: checkAnswers })[mode](rest);
for (const mistake of mistakes) console.error(mistake);
console.log(`${checks} verdicts, ${mistakes.length} wrong`);
process.exitCode = mistakes.length === 0 && checks > 0 ? 0 : 1;
