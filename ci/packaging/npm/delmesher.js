// The command line of delmesher, as a function: files go in and come out in memory.
import { Wasi } from "./wasi.js";

/** Compiles the module: beside this file, or given as bytes, a URL, or a compiled module. */
export async function load(source = new URL("delmesher.wasm", import.meta.url)) {
  let module = source;
  if (typeof source === "string" || source instanceof URL) {
    const url = new URL(source, import.meta.url);
    if (url.protocol === "file:") {
      const { readFile } = await import("node:fs/promises");
      module = await WebAssembly.compile(await readFile(url));
    } else {
      const response = await fetch(url);
      if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
      module = await WebAssembly.compile(await response.arrayBuffer());
    }
  } else if (!(source instanceof WebAssembly.Module)) {
    module = await WebAssembly.compile(source);
  }
  return new Delmesher(module);
}

export class Delmesher {
  constructor(module) {
    this.module = module;
  }

  /** Runs one command, such as ["mesh", "part.stl", "-o", "part.msh"], in a memory of its own. */
  run(args, { files = {}, onProgress } = {}) {
    let out = "", error = "";
    const wasi = new Wasi({
      args: ["delmesher", ...args],
      files,
      terminal: onProgress !== undefined,
      out: (text) => (out += text),
      error: (text) => {
        // Progress is a line that begins with a return, and overwrites the last one.
        if (onProgress === undefined || !text.startsWith("\r")) error += text;
        else if (text.trim() !== "") onProgress(text.trim());
      },
    });
    let code;
    try {
      code = wasi.start(new WebAssembly.Instance(this.module, wasi.imports));
    } catch (trap) {
      if (!(trap instanceof WebAssembly.RuntimeError || trap instanceof RangeError)) throw trap;
      code = 6;  // as the command line calls an internal error
      error += `delmesher: stopped: ${trap.message}\n`;
    }
    const written = {};
    for (const [name, file] of wasi.files) {
      if (!(name in files) || file.bytes !== files[name]) written[name] = file.content();
    }
    return { code, out, error, files: written };
  }
}
