// Writes a made-up sweep for the report: 3 scenes x 4 methods x 5 seeds with every state a cell can be in, and pictures
// whose pixels are known.
//
//     node tests/report/make_fixture.mjs DIR [WIDTH HEIGHT]     data.js, images/ and the files that are linked to
//
// Times fall and errors rise by laws with a little seeded noise, so that charts look like charts.

import {mkdirSync, writeFileSync} from "node:fs";
import {fileURLToPath} from "node:url";

import {draw_scene, pack, with_noise} from "./fixture_images.mjs";

const kMetrics = [
  {name: "rmse", values: "linear", better: "lower", unit: "W m^-2 sr^-1", formula: "sqrt(mean((x-r)^2))"},
  {name: "relmse", values: "linear", better: "lower", unit: "", formula: "mean((x-r)^2 / (r^2 + (0.1 mean r)^2))"},
  {name: "bias", values: "linear", better: "lower", unit: "W m^-2 sr^-1", formula: "mean(x-r)"},
  {
    name: "fireflies",
    values: "linear",
    better: "lower",
    unit: "",
    formula: "share of pixels far above all the reference shows nearby",
  },
  {name: "rmse_display", values: "display", better: "lower", unit: "", formula: "sqrt(mean((x-r)^2)) of sRGB values"},
  {name: "psnr", values: "display", better: "higher", unit: "dB", formula: "-20 log10 rmse"},
  {name: "ssim", values: "display", better: "higher", unit: "", formula: "structural similarity (Wang et al. 2004)"},
  {name: "flip", values: "display", better: "lower", unit: "", formula: "FLIP (Andersson et al. 2020)"},
];
const kMethods = [
  {id: "vpl", label: "vpl", integrator: "vpl", error: 0.9, speed: 1, power: -0.35, lights: [100, 400, 1600]},
  {
    id: "vsl",
    label: "vsl, 16 samples",
    integrator: "vsl",
    error: 0.35,
    speed: 7,
    power: -0.4,
    lights: [100, 400, 1600],
  },
  {
    id: "hvl-5",
    label: "hvl, 5 bands",
    integrator: "hvl",
    error: 0.28,
    speed: 1.6,
    power: -0.3,
    lights: [100, 400, 1600],
  },
  {id: "path", label: "path", integrator: "path", error: 1.1, speed: 40, power: -0.5, passes: [4, 16, 64]},
];
const kScenes = ["atrium", "cornell", "meshes <1>"];
const kSeeds = [0, 1, 2, 3, 4];

/// Numbers in [0, 1) that are the same every time (Park and Miller 1988).
export function random(seed) {
  let state = (seed % 2147483646) + 1;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

/// Two-sided Student interval of five values (t = 2.776 at 4 degrees of freedom).
function interval(values) {
  const mean = values.reduce((a, b) => a + b, 0) / values.length;
  const deviation = Math.sqrt(values.reduce((sum, v) => sum + (v - mean) ** 2, 0) / Math.max(1, values.length - 1));
  const half = values.length > 1 ? (2.776 * deviation) / Math.sqrt(values.length) : null;
  return {mean, low: half === null ? null : mean - half, high: half === null ? null : mean + half};
}

function scores_of(error, wobble) {
  const rmse = error * wobble;
  return {
    rmse,
    relmse: rmse * rmse * 2,
    bias: rmse * 0.2 * (wobble - 1.02),
    fireflies: rmse > 0.2 ? rmse / 1000 : 0,
    rmse_display: rmse / 3,
    psnr: -20 * Math.log10(rmse / 3),
    ssim: 1 - rmse ** 2 / 4,
    flip: rmse / 2,
  };
}

export function make_results() {
  const cells = [],
    groups = [],
    next = random(7);
  kScenes.forEach((scene, s) =>
    kMethods.forEach((method) =>
      (method.lights ?? method.passes).forEach((count, step) => {
        const varied = method.lights ? {lights: count} : {passes: count};
        const group = {
          id: groups.length,
          scene: `scene-${s}`,
          method: method.id,
          backend: "cpu",
          varied,
          budget: method.lights ? "1 pass" : `${count} passes`,
          cells: [],
          failed: 0,
          reference_limited: false,
        };
        const error = method.error * (1 + 0.4 * s) * (count / 4) ** method.power,
          seconds = 0.002 * method.speed * count * (1 + s);
        for (const seed of kSeeds) {
          const id = `${scene.slice(0, 2)}${s}-${method.id}-${count}-${seed}`;
          // hvl's seeds lie close together: bars smaller than its markers.
          const wobble = 1 + (next() - 0.5) * (method.id === "hvl-5" ? 0.01 : 0.3),
            time = seconds * (1 + (next() - 0.5) * 0.04);
          const scores = scores_of(error, wobble);
          cells.push({
            id,
            scene: `scene-${s}`,
            method: method.id,
            backend: "cpu",
            seed,
            group: group.id,
            budget: group.budget,
            repeat: `--set lights=${count} --seed ${seed}`,
            status: "done",
            reason: "",
            parameters: {...varied, bounces: 1},
            varied,
            passes: method.passes ? count : 1,
            seconds: {load: 0.2, begin_pass: time / 10, radiance: time * 0.9, output: 0.1},
            runs: [time * 0.99, time, time * 1.02],
            time,
            search: null,
            scores,
            reference: `reference-${s}`,
            reference_limited: false,
            image: seed === 0 ? `images/${id}.js` : null,
            curve: method.passes
              ? Array.from({length: Math.log2(count) + 1}, (_, k) => ({
                  passes: 2 ** k,
                  seconds: (time * 2 ** k) / count,
                  scores: scores_of(method.error * (1 + 0.4 * s) * (2 ** k / 4) ** -0.5, wobble),
                }))
              : [],
          });
          group.cells.push(id);
        }
        groups.push(group);
        special(group, cells, s, method, step);
        summarise(group, cells);
      }),
    ),
  );
  return {
    format: 1,
    program: {version: "0.1.0", compiler: "clang 16.0.6"},
    machine: {cpu: "A processor of 2 cores", threads: 2, gpu: null},
    created: "2026-11-22T23:01:00Z",
    sweep: {
      name: "fixture",
      title: 'Four methods & "three" <scenes>',
      description: "Made-up numbers that exercise every part of the page.",
      file: "fixture.json",
      text: '{\n  "scenes": ["atrium"],\n  "seeds": [0, 1, 2, 3, 4]\n}\n',
    },
    metrics: kMetrics,
    scenes: kScenes.map((name, s) => ({
      id: `scene-${s}`,
      name,
      file: `scenes/${s}.json`,
      frame: 0,
      width: 0,
      height: 0,
      exposure: 0.8,
    })),
    references: kScenes.map((_, s) => ({
      id: `reference-${s}`,
      scene: `scene-${s}`,
      transport: "one bounce, full occlusion",
      integrator: "path",
      parameters: {max_bounces: 1},
      passes: 4096,
      seeds: [11, 12],
      seconds: 734.2,
      floor: {rmse: 0.025 * (1 + s), flip: 0.01, ssim: 0.9999},
      image: `images/reference-${s}.js`,
    })),
    methods: kMethods.map(({id, label, integrator}) => ({id, label, integrator})),
    cells,
    groups,
    drift: [
      {after: 10, ratio: 0.998},
      {after: 20, ratio: 1.004},
      {after: 30, ratio: 1.013},
    ],
  };
}

/// One of each thing that goes wrong.
function special(group, cells, scene, method, step) {
  const mine = cells.filter((cell) => cell.group === group.id);
  const fail = (cell, reason) =>
    Object.assign(cell, {status: "failed", reason, time: null, runs: [], scores: {}, image: null, curve: []});
  if (scene === 0 && method.id === "vsl" && step === 2) fail(mine[3], "killed by signal 9 (out of memory?)");
  if (scene === 1 && method.id === "hvl-5" && step === 2)
    mine.forEach((cell) => fail(cell, 'scenes/1.json: material "brass"; not found'));
  if (scene === 2 && method.id === "vsl" && step === 2)
    mine.forEach((cell) =>
      Object.assign(cell, {
        status: "not_reached",
        search: {kind: "equal_time", parameter: "lights", target: 0.5, reached: cell.time, runs: 6},
      }),
    );
  if (method.id === "path" && step === 2) {
    group.reference_limited = true;
    mine.forEach((cell) => (cell.reference_limited = true));
  }
  group.failed = mine.filter((cell) => cell.status === "failed").length;
}

function summarise(group, cells) {
  const good = cells.filter((cell) => cell.group === group.id && cell.status !== "failed");
  group.scores = {};
  if (!good.length) return Object.assign(group, {time: null, noise: null, bias: null});
  group.time = {...interval(good.map((cell) => cell.time)), runs: 3 * good.length};
  for (const {name, better} of kMetrics) {
    const values = good.map((cell) => cell.scores[name]);
    const worst = better === "higher" ? Math.min(...values) : Math.max(...values);
    group.scores[name] = {...interval(values), worst, seeds: values.length};
  }
  group.noise = group.scores.rmse.mean * 0.3;
  group.bias = group.scores.rmse.mean * 0.95;
}

/// The files of a report's folder besides the page itself. The last method's first picture of scene 1 is left out.
export function write_fixture(folder, width = 320, height = 180) {
  const results = make_results();
  for (const scene of results.scenes) Object.assign(scene, {width, height});
  mkdirSync(`${folder}/images`, {recursive: true});
  writeFileSync(`${folder}/data.js`, `zonal_results(${JSON.stringify(results)});\n`);
  for (const file of ["results.csv", "table.md", "table.tex"]) writeFileSync(`${folder}/${file}`, "scene,method\n");
  const write = (file, image) => {
    const id = file.replace(/^images\/|\.js$/g, "");
    writeFileSync(
      `${folder}/${file}`,
      `zonal_image(${JSON.stringify(id)}, ${JSON.stringify({width, height, exposure: 0.8, data: pack(image)})});\n`,
    );
  };
  results.scenes.forEach((scene, s) => {
    const truth = draw_scene(s, width, height);
    write(`images/reference-${s}.js`, truth);
    for (const cell of results.cells.filter((c) => c.scene === scene.id && c.image))
      if (cell.image !== missing_image)
        write(cell.image, with_noise(truth, cell.scores.rmse, random(cell.group + 1)));
  });
  return results;
}

export const missing_image = "images/co1-path-4-0.js";

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [folder, width, height] = process.argv.slice(2);
  if (!folder) throw new Error("usage: make_fixture.mjs DIR [WIDTH HEIGHT]");
  write_fixture(folder, Number(width) || undefined, Number(height) || undefined);
}
