// What a service's /openapi.json says of its answers, as a check of each.
import Ajv2020 from "ajv/dist/2020.js";

// What the door answers wherever it stands, described in general.
const doors = new Set([400, 403, 406, 408, 411, 413, 414, 415, 417, 421, 431, 505]);

const escaped = (token) => encodeURIComponent(String(token).replaceAll("~", "~0").replaceAll("/", "~1"));

// The operation that a request is of, [template, method], by the path that fits with the fewest names in it.
export function operationOf(openapi, { method, path }) {
  const fits = (template) => new RegExp(`^${template.replace(/\./g, "\\.").replace(/{\w+}/g, "[^/]+")}$`).test(path);
  const names = (template) => template.split("{").length;
  const [template] = Object.keys(openapi.paths).filter(fits).sort((a, b) => names(a) - names(b));
  return template && [template, (method === "HEAD" ? "GET" : method).toLowerCase()];
}

// Checks of {method, path, status, type, body}, bodies of JSON as values: what is wrong, or null. After a check that went
// well, `described` says which `template method status` it was.
export function answerCheck(openapi, schemas) {
  const ajv = new Ajv2020({ allErrors: true, strict: false, validateFormats: false });
  for (const [name, schema] of Object.entries(schemas)) {
    ajv.addSchema({ ...schema, $id: `http://service/v1/schemas/${name}` });
  }
  ajv.addSchema({ ...openapi, $id: "http://service/openapi.json" }, undefined, undefined, false);
  const compiled = new Map();
  const validatorAt = (place) => {
    const pointer = place.map(escaped).join("/");
    if (!compiled.has(pointer)) compiled.set(pointer, ajv.compile({ $ref: `http://service/openapi.json#/${pointer}` }));
    return compiled.get(pointer);
  };
  const problem = ["components", "schemas", "problem"];

  return function check(exchange) {
    check.described = null;
    const name = `${exchange.method} ${exchange.path} ${exchange.status}`;
    const operation = operationOf(openapi, exchange);
    const described = operation && openapi.paths[operation[0]][operation[1]];
    let place = described && ["paths", ...operation, "responses", String(exchange.status)];
    let response = described?.responses[exchange.status];
    if (!response) {
      const isGeneral = doors.has(exchange.status) || (exchange.status === 405 && !described) || (exchange.status === 404 && !operation);
      if (!isGeneral) return `${name} is not described`;
      if (exchange.method === "HEAD") return null;
      if (exchange.type !== "application/problem+json") return `${name} is of the type ${exchange.type || "none"}`;
      return verdict(validatorAt(problem), exchange, name);
    }
    if (response.$ref) {
      place = response.$ref.slice(2).split("/");
      response = place.reduce((value, key) => value[key], openapi);
    }
    check.described = `${operation.join(" ")} ${exchange.status}`;
    const content = response.content?.[exchange.type];
    if (!content) return response.content || exchange.type ? `${name} is of the type ${exchange.type || "none"}` : null;
    if (!exchange.type.includes("json") || exchange.method === "HEAD") return null;
    const validate = validatorAt([...place, "content", exchange.type, "schema"]);
    if (validate({ surplus: [] }) && content.schema.type !== "object") return `${name}: its schema takes anything`;
    return verdict(validate, exchange, name);
  };

  function verdict(validate, exchange, name) {
    if (validate(exchange.body)) return null;
    return `${name} is not as described:\n    ${ajv.errorsText(validate.errors, { separator: "\n    " })}`;
  }
}
