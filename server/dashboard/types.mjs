// Writes src/generated/documents.d.ts: the types of the documents that the page draws, from the schemas that the
// engine's documents are held against, so that a page which misreads a document does not compile.
import { mkdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { compileFromFile } from "json-schema-to-typescript";

const here = dirname(fileURLToPath(import.meta.url));
const schemas = join(here, "../../schemas");
const view = await compileFromFile(join(schemas, "view.schema.json"), {
  cwd: schemas,
  additionalProperties: false,
  bannerComment: "/* From schemas/view.schema.json, by types.mjs. */",
  ignoreMinAndMaxItems: true,
  unreachableDefinitions: true,
});
mkdirSync(join(here, "src/generated"), { recursive: true });
writeFileSync(join(here, "src/generated/documents.d.ts"), view);
