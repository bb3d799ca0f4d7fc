/** What a command left: its exit code (docs/commands.md), its text, and the files that it wrote. */
export interface Result {
  code: number;
  out: string;
  error: string;
  files: Record<string, Uint8Array>;
}

export interface RunOptions {
  /** The files that the command can read, by name. */
  files?: Record<string, Uint8Array>;
  /** Called with each line of progress, such as "refine    about 40 %  12000 vertices". */
  onProgress?: (line: string) => void;
}

export declare class Delmesher {
  constructor(module: WebAssembly.Module);
  /** Runs one command to its end. Nothing can interrupt it but the end of its worker: run long ones in one. */
  run(args: string[], options?: RunOptions): Result;
}

/** Compiles the module: beside this file, or given as bytes, a URL, or a compiled module. */
export declare function load(source?: string | URL | BufferSource | WebAssembly.Module): Promise<Delmesher>;
