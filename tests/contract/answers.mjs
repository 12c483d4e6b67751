// What a service's /openapi.json says of its answers, as a check of each.
import Ajv2020 from "ajv/dist/2020.js";

const escaped = (token) => encodeURIComponent(String(token).replaceAll("~", "~0").replaceAll("/", "~1"));

// The operation that a request is of, [template, method], by the path that fits with the fewest names in it.
export function operationOf(openapi, { method, path }) {
  const fits = (template) => new RegExp(`^${template.replace(/\./g, "\\.").replace(/{\w+}/g, "[^/]+")}$`).test(path);
  const names = (template) => template.split("{").length;
  const [template] = Object.keys(openapi.paths).filter(fits).sort((a, b) => names(a) - names(b));
  return template && [template, (method === "HEAD" ? "GET" : method).toLowerCase()];
}

const isJson = (type) => type === "application/json" || type === "application/problem+json";

// An answer as tests noted it (tests/server/recorder.hpp), as it is checked.
export function asNoted({ answerer, method, target, status, head, body }) {
  const headers = {};
  for (const line of head.split("\r\n").filter((each) => each.includes(": "))) {
    const [name, ...value] = line.split(": ");
    headers[name.toLowerCase()] = [headers[name.toLowerCase()], value.join(": ")].filter(Boolean).join(", ");
  }
  const type = (headers["content-type"] ?? "").split(";")[0];
  const text = Buffer.from(body, "latin1").toString("utf8");
  return { answerer, method, path: target.split("?")[0], status, type, headers, body: isJson(type) && text ? JSON.parse(text) : text };
}

// Checks of {method, path, status, type, headers, body}, bodies of JSON as values: what is wrong, or null. Answers of the
// door alone (`answerer`) must be problems that any request may be answered with. After a check that went well,
// `described` says which `template method status` it was.
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
  const at = (place) => place.reduce((value, key) => value?.[key], openapi);
  const followed = (place) => at(place)?.$ref ? at(place).$ref.slice(2).split("/") : place;

  // Where the answer is described, and whether with its operation.
  function placeOf(exchange) {
    const operation = exchange.answerer === "door" ? undefined : operationOf(openapi, exchange);
    const own = operation && ["paths", ...operation, "responses", String(exchange.status)];
    if (own && at(own)) return [followed(own), `${operation.join(" ")} ${exchange.status}`];
    const isMisplaced = (exchange.status === 404 && operation) || (exchange.status === 405 && operation && at(["paths", ...operation]));
    const general = ["x-anywhere", String(exchange.status)];
    return at(general) && !isMisplaced ? [followed(general), `anywhere ${exchange.status}`] : [];
  }

  function headerMistake(exchange, place, name) {
    for (const field of Object.keys(at(place).headers ?? {})) {
      const header = at(followed([...place, "headers", field]));
      const value = exchange.headers[field.toLowerCase()];
      if (value === undefined ? header.required : header.schema.type === "integer" && !/^[1-9]\d*$/.test(value)) {
        return `${name} has ${value === undefined ? "no" : `the odd (${value})`} ${field}`;
      }
    }
    return null;
  }

  function verdict(validate, body, name) {
    if (validate(body)) return null;
    return `${name} is not as described:\n    ${ajv.errorsText(validate.errors, { separator: "\n    " })}`;
  }

  // The data of the events that a stream told of, but of one that it broke off in.
  const dataIn = (stream) => stream.split("\n\n").slice(0, -1).flatMap((event) => event.split("\n"))
    .filter((line) => line.startsWith("data: ")).map((line) => JSON.parse(line.slice(6)));

  return function check(exchange) {
    check.described = null;
    const name = `${exchange.method} ${exchange.path} ${exchange.status}`;
    const [place, described] = placeOf(exchange);
    if (!place) return `${name} is not described`;
    check.described = described;
    const response = at(place);
    const mistake = headerMistake(exchange, place, name);
    if (mistake) return mistake;
    const content = response.content?.[exchange.type];
    if (!content) return response.content || exchange.type ? `${name} is of the type ${exchange.type || "none"}` : null;
    if (exchange.method === "HEAD") return null;
    const media = [...place, "content", exchange.type];
    if (content["x-event-data"]) {
      const validate = validatorAt([...media, "x-event-data"]);
      return dataIn(exchange.body).map((data) => verdict(validate, data, name)).find(Boolean) ?? null;
    }
    if (!isJson(exchange.type)) return null;
    const validate = validatorAt([...media, "schema"]);
    if (validate({ surplus: [] }) && content.schema.type !== "object") return `${name}: its schema takes anything`;
    return verdict(validate, exchange.body, name);
  };
}
