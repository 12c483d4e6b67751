// Between a service and clients that are not of our making: hands everything on, and notes every answer in the directory
// that STEERSTAT_ANSWERS names, for tests/contract to hold it against schemas/openapi.yaml.
//
//   node relay.mjs PORT     relays to 127.0.0.1:PORT, says at which port, and goes on until it is ended
import { appendFileSync } from "node:fs";
import { createServer, request } from "node:http";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

export function noteAnswer(method, target, status, head, body) {
  const directory = process.env.STEERSTAT_ANSWERS;
  if (!directory) return;
  const line = JSON.stringify({ answerer: "service", method, target, status, head, body: body.toString("latin1") });
  appendFileSync(join(directory, `relay-${process.pid}.jsonl`), `${line}\n`);
}

const headOf = (raw) => raw.map((text, i) => text + (i % 2 === 0 ? ": " : "\r\n")).join("");

/** Relays to whatever listens at 127.0.0.1:`port()`, as long as the server that it returns is open. */
export function relayTo(port) {
  return createServer((question, reply) => {
    const { method, url: path, headers } = question;
    const onward = request({ host: "127.0.0.1", port: port(), method, path, headers, agent: false }, (answer) => {
      const pieces = [];
      reply.writeHead(answer.statusCode, answer.rawHeaders);
      answer.on("data", (piece) => {
        pieces.push(piece);
        reply.write(piece);
      });
      answer.on("close", () => { // a stream of events may end in the middle
        const isWhole = answer.complete || answer.headers["content-type"] === "text/event-stream";
        if (isWhole) noteAnswer(method, path, answer.statusCode, headOf(answer.rawHeaders), Buffer.concat(pieces));
        if (answer.complete) reply.end();
        else reply.destroy();
      });
      answer.on("error", () => reply.destroy());
    });
    onward.on("error", () => reply.destroy());
    reply.on("close", () => onward.destroy());
    question.pipe(onward);
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const server = relayTo(() => Number(process.argv[2]));
  server.listen(0, "127.0.0.1", () => console.log(server.address().port));
}
