import { listedText, readListed } from "./listed";
import { describe, expect, it } from "vitest";
import { allFields, metricNames, rateNames, sections } from "./fields";
import { lineOf, locate } from "./locate";
import { type Json, formatSpec, getAt, isWithin, parsePointer, setAt, toPointer } from "./pointer";
import { shipped } from "./shipped";
import { begin, build, centre, kindOf, parseNumber, parseNumbers, partsOf, valueKinds } from "./value";

describe("listed trials", () => {
  const trials = [{ "plant.m1": 1.1, "initial_state.q2": -0.3 }, { "plant.m1": 0.9 }];
  it("are the same as text and back", () => {
    expect(listedText(trials)).toBe("plant.m1, initial_state.q2\n1.1, -0.3\n0.9, ");
    expect(readListed(listedText(trials))).toEqual(trials);
    expect(readListed(" \n")).toBeUndefined();
  });
  it("say in which line they are none", () => {
    expect(readListed("plant.m1\n1\n1, 2")).toBe("line 3: 2 values, and there are 1 names");
    expect(readListed("plant.m1\nx")).toBe("line 2: x is no number");
    expect(readListed("plant.m1,,\n1,2,3")).toMatch(/^line 1/);
  });
});

describe("the form's fields", () => {
  it("cover every number of plant, initial state, controller, actuator and sensor", () => {
    const values = allFields.filter((field) => field.kind === "value").map((field) => field.path.join("."));
    for (const name of ["plant.m1", "plant.coulomb_speed2", "initial_state.q2_dot", "controller.contraction.eta1", "controller.swing.min_authority", "actuator.max_force", "sensor.noise.q1_dot"]) expect(values).toContain(name);
  });
  it("have units, defaults and choices from the schema", () => {
    const field = (path: string) => allFields.find((each) => each.path.join(".") === path);
    expect(field("plant.f2")).toMatchObject({ unit: "N m s/rad", canBeRelative: true, description: "Viscous friction of the rotational joint." });
    expect(field("horizon")).toMatchObject({ kind: "number", unit: "s", default: 300 });
    expect(field("controller.realignment")).toMatchObject({ kind: "choice", choices: ["never", "after_cycle", "always"] });
    expect(field("audit.trials")?.kind).toBe("integer");
    expect(sections.every((section) => section.fields.length > 0)).toBe(true);
    expect(rateNames).toContain("success_rate");
    expect(metricNames).toContain("settling_time");
  });
});

describe("shipped specs", () => {
  it("are there, read as JSON, and their values are ones that the form knows", () => {
    expect(shipped.map((each) => each.name)).toContain("combined");
    expect(shipped.length).toBeGreaterThan(8);
    for (const { name, text } of shipped) {
      expect(locate(text).mistake, name).toBeNull();
      const spec = JSON.parse(text) as Json;
      for (const field of allFields) if (field.kind === "value") expect(kindOf(getAt(spec, field.path)), `${name} ${field.path.join(".")}`).not.toBe("other");
    }
  });
  it("are the same JSON after tidying", () => {
    for (const { text } of shipped) expect(JSON.parse(formatSpec(JSON.parse(text) as Json))).toEqual(JSON.parse(text));
  });
});

describe("values", () => {
  it("of every kind come back from their parts", () => {
    for (const kind of valueKinds) {
      if (kind === "default" || kind === "other") continue;
      const value = build(kind, begin(kind, 0.5), false);
      expect(kindOf(value)).toBe(kind);
      expect(build(kind, partsOf(value, kind), false)).toEqual(value);
    }
  });
  it("begin around the number that was there", () => {
    expect(centre({ uniform: [0.8, 1.2] }, 0)).toBe(1);
    expect(centre({ sweep: [1, 2, 3] }, 0)).toBe(2);
    expect(centre(undefined, 7)).toBe(7);
    expect(begin("uniform", 0)).toEqual({ low: 0, high: 0.05 });
  });
  it("that the form cannot show stay as they are", () => {
    expect(kindOf({ uniform: [1, "x"] } as Json)).toBe("other");
    expect(kindOf({ uniform: [1] })).toBe("other");
    expect(kindOf({ uniform: [0, 1], normal: { mean: 0, std: 1 } })).toBe("other");
    expect(kindOf("1")).toBe("other");
  });
  it("may be relative", () => {
    expect(build("uniform", { low: 0.8, high: 1.2 }, true)).toEqual({ uniform: [0.8, 1.2], relative: true });
    expect(build("number", { value: 1 }, true)).toBe(1);
  });
  it("are read as people write them", () => {
    expect(["1", " -.5", "1e-3", "−2", "1.", "", "1e", "0x1", "Infinity", "1,5"].map(parseNumber)).toEqual([1, -0.5, 0.001, -2, 1, null, null, null, null, null]);
    expect(parseNumbers("0.3, 0.5 0.7")).toEqual([0.3, 0.5, 0.7]);
    expect(parseNumbers("0.3, x")).toBeNull();
  });
});

describe("places in a spec", () => {
  it("are pointers, there and back", () => {
    expect(toPointer(["a/b", "c~d", "0"])).toBe("/a~1b/c~0d/0");
    expect(parsePointer("/a~1b/c~0d/0")).toEqual(["a/b", "c~d", "0"]);
    expect(isWithin("/plant/m1/uniform", ["plant", "m1"])).toBe(true);
    expect(isWithin("/plant/m12", ["plant", "m1"])).toBe(false);
  });
  it("are set without changing the original, and emptied objects go", () => {
    const spec: Json = { plant: { m1: 1 }, name: "x" };
    expect(setAt(spec, ["plant", "m2"], 2)).toEqual({ plant: { m1: 1, m2: 2 }, name: "x" });
    expect(setAt(spec, ["plant", "m1"], undefined)).toEqual({ name: "x" });
    expect(setAt(spec, ["controller", "contraction", "eta1"], 0.4)).toMatchObject({ controller: { contraction: { eta1: 0.4 } } });
    expect(spec).toEqual({ plant: { m1: 1 }, name: "x" });
  });
});

describe("locate", () => {
  const text = '{\n  "plant": {\n    "m1": {"uniform": [1.2,\n      0.8]}\n  },\n  "gates": [\n    {"metric": "x"}\n  ]\n}';
  it("knows the line of each value", () => {
    const located = locate(text);
    expect(located.mistake).toBeNull();
    expect(["/plant", "/plant/m1", "/plant/m1/uniform/1", "/gates/0/metric"].map((pointer) => lineOf(located, pointer))).toEqual([2, 3, 4, 7]);
  });
  it("gives the nearest place around one that is not there", () => {
    expect(lineOf(locate(text), "/plant/m9/uniform")).toBe(2);
    expect(lineOf(locate(text), "/horizon")).toBe(1);
  });
  it("tells what is wrong, and where", () => {
    const wrong = (bad: string) => locate(bad).mistake;
    expect(wrong('{\n "a": 1,\n}')).toMatchObject({ line: 3 });
    expect(wrong('{"a" 1}')?.detail).toContain(":");
    expect(wrong('{"a": 01}')).not.toBeNull();
    expect(wrong('{"a": 1, "a": 2}')?.detail).toContain("twice");
    expect(wrong('{"a": "x\n"}')?.line).toBe(1);
    expect(wrong("{} x")?.detail).toContain("after the end");
    expect(wrong("")?.detail).toContain("the end");
  });
  it("agrees with JSON.parse on what is JSON", () => {
    for (const sample of ["1", "-0.5e+3", "[]", "{}", "[1,[2,{\"a\":null}]]", '"\\u00e9\\n"', "tru", "[1 2]", "[1,]", "{,}", "1.", ".5", "+1", "NaN", '"\\x"', "nulls"]) {
      let isJson = true;
      try {
        JSON.parse(sample);
      } catch {
        isJson = false;
      }
      expect(locate(sample).mistake === null, sample).toBe(isJson);
    }
  });
});
