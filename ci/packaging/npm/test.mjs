// Compares the modules with the native programs: exit codes, text and bytes of all files, verdicts; and their times.
// Usage: node ci/packaging/npm/test.mjs DELMESHER MODEL...      tetproof lies beside DELMESHER, delmesher.wasm and tetproof.wasm beside this file.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join, resolve } from "node:path";
import { gzipSync } from "node:zlib";
import { load, loadVerifier } from "./delmesher.js";

const [program, ...models] = process.argv.slice(2);
if (models.length === 0) throw new Error("usage: node test.mjs DELMESHER MODEL...");
const native = resolve(program);
const delmesher = await load(), verifier = await loadVerifier();
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

// But for times, and for which of many such tiny angles the last digit of an arc calls the smallest.
const lasting = (text) => text.replaceAll(/ in [0-9.]+ s;/g, " in N s;").replaceAll(/( angle is [0-9.]+e-[0-9]+ degrees).*/g, "$1");
let wrong = 0, compared = 0, placed = 0;
const time = { native: 0, wasm: 0 }, verdicts = {};

/** In a folder of its own that has the files. */
function in_folder(files, use) {
  const folder = mkdtempSync(join(tmpdir(), "delmesher-"));
  try {
    for (const [name, bytes] of Object.entries(files)) writeFileSync(join(folder, name), bytes);
    return use(folder);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

function compare(args, name, bytes) {
  in_folder({ [name]: bytes }, (folder) => {
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
    if (lasting(found.error) !== lasting(expected.stderr)) complain(`says\n${found.error}not\n${expected.stderr}`);
    const names = [Object.keys(found.files), Object.keys(written)].map((list) => list.sort().join(" "));
    if (names[0] !== names[1]) complain(`wrote ${names[0]}, not ${names[1]}`);
    for (const [file, content] of Object.entries(written)) {
      if (found.files[file] !== undefined && !content.equals(found.files[file])) complain(`${file}: other bytes`);
    }
  });
}

// Without CGAL, which oracles "input" and "hull" ask, and with other functions of angles: figures may differ in their last digits.
const same_figures = (a = {}, b = {}) => Object.keys(a).length === Object.keys(b).length &&
  Object.entries(a).every(([key, value]) => Math.abs(value - b[key]) <= 1e-9 * Math.abs(value));

function compare_verdicts(surface, mesh, promised) {
  return in_folder({ [surface.name]: surface.bytes, [mesh.name]: mesh.bytes }, (folder) => {
    const words = ["verify", surface.name, mesh.name, "--promised", promised, "--json"];
    const expected = spawnSync(join(dirname(native), "tetproof"), words, { cwd: folder, encoding: "utf8", maxBuffer: 2 ** 30 });
    const theirs = JSON.parse(expected.stdout), ours = verifier.verify(surface, mesh, { promised });
    const complain = (what) => {
      ++wrong;
      console.log(`${words.join(" ")}: ${what}`);
    };
    ++compared;
    verdicts[theirs.verdict] = (verdicts[theirs.verdict] ?? 0) + 1;
    if (ours.verdict !== theirs.verdict || ours.passed !== (expected.status === 0)) complain(`${ours.verdict}, not ${theirs.verdict}`);
    const left = ours.unproven.filter((line) => !line.includes("CGAL"));
    if (left.join() !== (theirs.unproven ?? []).join() || (!promised.includes("--tolerance") && left.length === ours.unproven.length)) complain(`unproven: ${ours.unproven}, not ${theirs.unproven}`);
    const said = ({ name, status, checked, violations, findings, places }) => JSON.stringify([name, status, checked, violations, findings, places]);
    const asked = ({ name, status, checked }) => name === "hull" && status + checked;
    const judges = theirs.oracles.filter(({ name }) => name !== "input");
    if (ours.report.oracles.length !== judges.length) complain("not the same oracles");
    ours.report.oracles.forEach((oracle, n) => {
      const other = judges[n] ?? {};
      const same = said(oracle) === said(other) && same_figures(other.figures, oracle.figures);
      if (!same && (!asked(oracle) || asked(oracle) !== asked(other))) complain(`says ${JSON.stringify(oracle)}, not ${JSON.stringify(other)}`);
    });
    if ((ours.reasons.length > 0) !== ["broken", "undecided"].includes(ours.verdict)) complain(`reasons: ${JSON.stringify(ours.reasons)}`);
    return ours;
  });
}

// The mesh as it is, one that lacks a tetrahedron, one with a vertex moved.
function verify_meshes(surface) {
  for (const options of [[], ["--surface", "split"], ["--tolerance", "1e-3d"]]) {
    const made = delmesher.run(["mesh", surface.name, "-o", "out.mesh", ...options], { files: { [surface.name]: surface.bytes } });
    if (made.code !== 0) continue;
    const promised = ["mesh", ...options].join(" "), text = new TextDecoder().decode(made.files["out.mesh"]);
    const verdict = (content) => compare_verdicts(surface, { name: "out.mesh", bytes: new TextEncoder().encode(content) }, promised);
    verdict(text);
    compare_verdicts(surface, { name: "out.mesh.gz", bytes: gzipSync(text) }, promised);
    const less = text.replace(/(\nTetrahedra\n)(\d+)\n.*\n/, (_, head, count) => `${head}${count - 1}\n`);
    const moved = text.replace(/(\nVertices\n\d+\n)\S+/, (_, head) => `${head}12345`);
    for (const damaged of [less, moved]) {
      const found = damaged === text ? {} : verdict(damaged);
      if (found.verdict !== "broken") ++wrong, console.log(`${surface.name}: a damaged mesh is ${found.verdict}`);
      placed += found.reasons?.filter(({ place }) => place?.at).length ?? 0;
    }
  }
}

// With the record, and the mesh in formats of other readers: each oracle that does not ask CGAL says the same.
function verify_records(surface) {
  for (const format of ["msh", "vtu"]) {
    const mesh = `out.${format}`, files = { [surface.name]: surface.bytes };
    const made = delmesher.run(["mesh", surface.name, "-o", mesh, "--surface", "split", "--exact", "out.exact"], { files });
    if (made.code !== 0) continue;
    const words = ["verify", surface.name, mesh, "--exact", "out.exact", "--promised", "mesh --surface split", "--json"];
    const all = { ...files, ...made.files };
    in_folder(all, (folder) => {
      const expected = spawnSync(join(dirname(native), "tetproof"), words, { cwd: folder, encoding: "utf8", maxBuffer: 2 ** 30 });
      const found = verifier.program.run(words, { files: all });
      const said = (text) => JSON.parse(text).oracles.filter(({ name }) => !["input", "hull", "exact-second-kernel"].includes(name))
        .map(({ name, status, checked, violations }) => [name, status, checked, violations].join(" ")).join("; ");
      ++compared;
      if (found.code !== expected.status || said(found.out) !== said(expected.stdout)) {
        ++wrong;
        console.log(`${words.join(" ")}: ${said(found.out)}, not ${said(expected.stdout)}`);
      }
    });
  }
}

for (const model of models) {
  const name = basename(model), bytes = readFileSync(model);
  for (const args of kCommands) compare(args, name, bytes);
  verify_meshes({ name, bytes });
  verify_records({ name, bytes });
}
for (const [surface, mesh] of [["missing.foo", "out.msh"], ["x.off", "out.foo"]]) {
  try {
    verifier.verify({ name: surface, bytes: readFileSync(models[0]) }, { name: mesh, bytes: new Uint8Array(8) });
    ++wrong, console.log(`${surface}, ${mesh}: verified`);
  } catch (error) {
    if (!error.message.startsWith("tetproof: ")) throw error;
  }
}
const bytes = readFileSync(models[0]), name = basename(models[0]);
for (const args of kErrors) compare(args, name, bytes);
for (const level of [0, 1, 9]) compare(["check", "IN"], name + ".gz", gzipSync(bytes, { level }));
const packed = gzipSync(bytes);
compare(["check", "IN"], name + ".gz", packed.subarray(0, packed.length / 2));
for (const at of [0.1, 0.3, 0.5, 0.7, 0.9, 1]) {
  const damaged = Buffer.from(packed);
  damaged[Math.min(Math.floor(at * packed.length), packed.length - 5)] ^= 0x55;
  compare(["check", "IN"], name + ".gz", damaged);
}
compare(["check", "IN"], "words.stl", Buffer.from("solid x\nfacet normal 0 0\nwrong\n"));
if (!verdicts.broken || !verdicts.exact || !placed) ++wrong;
console.log(`${compared} commands compared, ${wrong} differences; verdicts: ${JSON.stringify(verdicts)}, ${placed} places; meshes: native ${(time.native / 1000).toFixed(1)} s, ` +
  `module ${(time.wasm / 1000).toFixed(1)} s, ${(time.wasm / time.native).toFixed(2)} times`);
process.exit(wrong === 0 && compared > 0 ? 0 : 1);
