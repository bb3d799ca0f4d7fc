// The command lines of delmesher and of `tetproof verify`, as functions: files go in and come out in memory.
import { Wasi } from "./wasi.js";

/** Of bytes, a URL, or compiled already. */
export async function compile(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source !== "string" && !(source instanceof URL)) return WebAssembly.compile(source);
  const url = new URL(source, import.meta.url);
  if (url.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return WebAssembly.compile(await readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

/** Compiles the module: beside this file, or given as bytes, a URL, or a compiled module. */
export async function load(source = new URL("delmesher.wasm", import.meta.url)) {
  return new Delmesher(await compile(source));
}

/** The same of the module that verifies. */
export async function loadVerifier(source = new URL("tetproof.wasm", import.meta.url)) {
  return new Verifier(await compile(source));
}

export class Delmesher {
  constructor(module, name = "delmesher") {
    this.module = module;
    this.name = name;
  }

  /** Runs one command, such as ["mesh", "part.stl", "-o", "part.msh"], in a memory of its own. */
  run(args, { files = {}, onProgress } = {}) {
    let out = "", error = "";
    const wasi = new Wasi({
      args: [this.name, ...args],
      files,
      terminal: onProgress !== undefined,
      out: (text) => (out += text),
      error: (text) => {
        // Progress is a line that begins with a return, and overwrites the last one.
        if (onProgress === undefined || !text.startsWith("\r")) error += text;
        else if ((text = text.replace("\x1b[K", "").trim()) !== "") onProgress(text);
      },
    });
    let code;
    try {
      code = wasi.start(new WebAssembly.Instance(this.module, wasi.imports));
    } catch (trap) {
      if (!(trap instanceof WebAssembly.RuntimeError || trap instanceof RangeError)) throw trap;
      code = 6;  // as the command line calls an internal error
      error += `${this.name}: stopped: ${trap.message}\n`;
    }
    const written = {};
    for (const [name, file] of wasi.files) {
      if (!(name in files) || file.bytes !== files[name]) written[name] = file.content();
    }
    return { code, out, error, files: written };
  }
}

export class Verifier {
  constructor(module) {
    this.program = new Delmesher(module, "tetproof");
  }

  /** Is the mesh one of the surface? Judged as by `tetproof verify SURFACE MESH --json`; throws an Error where a file cannot be read. */
  verify(surface, mesh, { promised = "mesh", onProgress } = {}) {
    const paths = [surface, mesh].map(({ name }) => (name.startsWith("-") ? `./${name}` : name));
    if (surface.name === mesh.name) throw new Error(`${mesh.name}: the surface and the mesh need different names`);
    const files = { [surface.name]: surface.bytes, [mesh.name]: mesh.bytes };
    const { code, out, error } = this.program.run(["verify", ...paths, "--promised", promised, "--json"], { files, onProgress });
    if (!out.startsWith("{")) throw new Error(error.trim());
    const report = JSON.parse(out);
    const reasons = report.oracles.filter(({ status }) => status === "FAIL" || status === "undecided").flatMap(({ name, findings, places, notes }) =>
      (findings.length > 0 ? findings : notes.length > 0 ? notes.slice(-1) : ["nothing to check"]).map((text, n) => ({ oracle: name, text, place: places[n] ?? undefined })));
    return { verdict: report.verdict, passed: code === 0, reasons, unproven: report.unproven ?? [], report };
  }
}
