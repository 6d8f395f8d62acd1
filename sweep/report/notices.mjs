// Appends to a bundle the licences of the packages in it, as these ask for:
//     node notices.mjs META.json BUNDLE.js      META.json: esbuild's --metafile, relative to this folder
// Packages that share a licence text share it here; their copyright lines are kept apart.

import {appendFileSync, readdirSync, readFileSync} from "node:fs";

const [meta, bundle] = process.argv.slice(2);
const folders = new Set(
  Object.keys(JSON.parse(readFileSync(meta, "utf8")).inputs)
    .map((file) => /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(file)?.[1])
    .filter(Boolean),
);

const packages_of = new Map(); // licence text -> lines "name version: Copyright ..."
for (const folder of [...folders].sort()) {
  const {name, version} = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) throw new Error(`${name} comes without a licence`);
  const lines = readFileSync(`${folder}/${file}`, "utf8").trim().split("\n");
  const copyright = lines.filter((line) => /^copyright/i.test(line)).join("; ");
  const text = lines
    .filter((line) => !/^copyright/i.test(line))
    .join("\n")
    .trim();
  // Line breaks are no difference.
  const key = text.replace(/\s+/g, " ");
  packages_of.set(key, {
    text,
    packages: [...(packages_of.get(key)?.packages ?? []), `${name} ${version}: ${copyright}`],
  });
}

const notices = [...packages_of.values()]
  .map(({text, packages}) => `${packages.join("\n")}\n\n${text}`)
  .join("\n\n---\n\n");
appendFileSync(bundle, `\n/*! Contains:\n\n${notices.replaceAll("*/", "* /")}\n*/\n`);
