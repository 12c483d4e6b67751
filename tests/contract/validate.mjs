// Holds JSON documents against the schemas, with ajv.
//
//   node validate.mjs specs SCHEMA SPECS CORPUS     shipped specs and the corpus' verdicts
//   node validate.mjs approximations SCHEMA SPECS CORPUS     the same for approximation studies
//   node validate.mjs summaries SCHEMA SUMMARY...   summaries pass, and every broken copy of one is refused
//   node validate.mjs exchanges SESSION     a service's answers, each against what its own /openapi.json says of it
//
// Exits 1 after naming every document with the wrong verdict, and where there was nothing to check.
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import Ajv2020 from "ajv/dist/2020.js";
import { answerCheck } from "./answers.mjs";

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
    if (![...seen].some((key) => key?.startsWith(`${operation} 2`))) mistakes.push(`${operation} was never answered well`);
  }
}

const [mode, ...rest] = process.argv.slice(2);
const checkApproximations = (files) => checkSpecs(files, isApproximation);
({ specs: checkSpecs, approximations: checkApproximations, summaries: checkSummaries, exchanges: checkExchanges })[mode](rest);
for (const mistake of mistakes) console.error(mistake);
console.log(`${checks} verdicts, ${mistakes.length} wrong`);
process.exitCode = mistakes.length === 0 && checks > 0 ? 0 : 1;
