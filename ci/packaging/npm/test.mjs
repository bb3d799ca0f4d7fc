// Compares the module with the native program: exit codes, text and bytes of all files; and their times.
// Usage: node ci/packaging/npm/test.mjs DELMESHER MODEL...      delmesher.wasm lies beside this file, or is named by DELMESHER_WASM.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { gunzipSync, gzipSync } from "node:zlib";
import { load } from "./delmesher.js";

const [program, ...models] = process.argv.slice(2);
if (models.length === 0) throw new Error("usage: node test.mjs DELMESHER MODEL...");
const native = resolve(program);
const wasm = process.env.DELMESHER_WASM;
const delmesher = await load(wasm === undefined ? undefined : pathToFileURL(resolve(wasm)));
const kCommands = [
  ["check", "IN"],
  ["check", "IN", "--json", "--defects", "defects.vtu"],
  ["mesh", "IN", "-o", "out.msh", "-o", "out.vtu", "-o", "out.inp"],
  ["mesh", "IN", "-o", "out.msh", "--ascii", "--surface", "split", "--exact", "out.exact"],
  ["mesh", "IN", "-o", "folder/out.mesh", "--size", "0.3", "--order", "2"],
  ["mesh", "IN", "-o", "out.tet", "--tolerance", "1e-3d"],
  ["repair", "IN", "-o", "mended.stl"],
];
const kErrors = [
  ["--version"], ["--help"], ["mesh", "IN"], ["mesh", "missing.stl", "-o", "out.msh"], ["mesh", "IN", "-o", "out.foo"],
  ["mesh", "IN", "-o", "out.msh", "--size", "-1"], ["mesh", "IN", "-o", "out.msh", "--delta", "80"], ["mseh"], ["mesh", "IN", "-o", "out.msh", "--max-vertices", "5"],
];

const seconds = (text) => text.replaceAll(/ in [0-9.]+ s;/g, " in N s;");
let wrong = 0, compared = 0;
const time = { native: 0, wasm: 0 };

function compare(args, name, bytes) {
  const folder = mkdtempSync(join(tmpdir(), "delmesher-"));
  try {
    writeFileSync(join(folder, name), bytes);
    const words = args.map((word) => (word === "IN" ? name : word));
    const began = performance.now();
    const expected = spawnSync(native, words, { cwd: folder, encoding: "utf8", maxBuffer: 2 ** 30 });
    const middle = performance.now();
    const found = delmesher.run(words, { files: { [name]: bytes } });
    const end = performance.now();
    if (words[0] === "mesh" && expected.status === 0) {
      time.native += middle - began;
      time.wasm += end - middle;
    }
    const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile() && entry.name !== name);
    const written = Object.fromEntries(files.map((entry) => {
      const path = join(entry.path, entry.name);
      return [path.slice(folder.length + 1), readFileSync(path)];
    }));
    const complain = (what) => {
      ++wrong;
      console.log(`${words.join(" ")}: ${what}`);
    };
    ++compared;
    if (found.code !== expected.status) complain(`exit code ${found.code}, not ${expected.status}: ${found.error}`);
    if (found.out !== expected.stdout) complain(`says\n${found.out}not\n${expected.stdout}`);
    if (seconds(found.error) !== seconds(expected.stderr)) complain(`says\n${found.error}not\n${expected.stderr}`);
    const names = [Object.keys(found.files), Object.keys(written)].map((list) => list.sort().join(" "));
    if (names[0] !== names[1]) complain(`wrote ${names[0]}, not ${names[1]}`);
    for (const [file, content] of Object.entries(written)) {
      if (found.files[file] !== undefined && !content.equals(found.files[file])) complain(`${file}: other bytes`);
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
}

for (const model of models) {
  const name = basename(model), bytes = readFileSync(model);
  for (const args of kCommands) compare(args, name, bytes);
}
const bytes = readFileSync(models[0]), name = basename(models[0]);
for (const args of kErrors) compare(args, name, bytes);
for (const level of [0, 1, 9]) compare(["check", "IN"], name + ".gz", gzipSync(bytes, { level }));
const packed = gzipSync(bytes);
compare(["check", "IN"], name + ".gz", packed.subarray(0, packed.length / 2));
for (const at of [0.1, 0.3, 0.5, 0.7, 0.9, 1]) {
  const damaged = Buffer.from(packed);
  damaged[Math.min(Math.floor(at * packed.length), packed.length - 5)] ^= 0x55;
  try {
    gunzipSync(damaged);
  } catch {
    // Both refuse it; where each notices, and so its message, may differ.
    const codes = [delmesher.run(["check", "x.gz"], { files: { "x.gz": damaged } }).code];
    if (codes[0] !== 3) ++wrong, console.log(`a damaged file: exit code ${codes[0]}, not 3`);
  }
}
compare(["check", "IN"], "words.stl", Buffer.from("solid x\nfacet normal 0 0\nwrong\n"));
console.log(`${compared} commands compared, ${wrong} differences; meshes: native ${(time.native / 1000).toFixed(1)} s, ` +
  `module ${(time.wasm / 1000).toFixed(1)} s, ${(time.wasm / time.native).toFixed(2)} times`);
process.exit(wrong === 0 && compared > 0 ? 0 : 1);
