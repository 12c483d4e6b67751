// The specs that come with the program, from the folder that the variable SPECS names.
import { readFileSync } from "node:fs";
import { join } from "node:path";

export const shipped = (name) => JSON.parse(readFileSync(join(process.env.SPECS, `${name}.json`), "utf8"));
