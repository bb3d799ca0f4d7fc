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

/** A file: its name says the format. */
export interface NamedFile {
  name: string;
  bytes: Uint8Array;
}

export interface VerifyOptions {
  /** What was asked for, as `tetproof verify --promised` takes it ("mesh"). */
  promised?: string;
  onProgress?: (line: string) => void;
}

/** An element by its number, or those of its corners, from 0; and its middle, or the point where something is wrong. */
export interface Place {
  kind?: "vertices" | "edges" | "faces" | "tetrahedra" | "listed triangles" | "input vertices" | "input edges" | "input triangles";
  numbers?: number[];
  at?: [number, number, number];
}

/** A violation, and where it is, unless it is nowhere. */
export interface Reason {
  oracle: string;
  text: string;
  place?: Place;
}

export interface Verdict {
  /** As docs/commands.md explains them. */
  verdict: "exact" | "rounded" | "deviating" | "undecided" | "broken";
  passed: boolean;
  /** For each oracle that failed the first five violations; for each that cannot decide, why. */
  reasons: Reason[];
  /** What is taken for granted, and was not shown. */
  unproven: string[];
  /** All that `tetproof verify --json` writes. */
  report: Record<string, unknown>;
}

export declare class Verifier {
  constructor(module: WebAssembly.Module);
  /** Is the mesh one of the surface? Formats of one file each, under different names. Throws an Error where one cannot be read, or the surface bounds no solid. */
  verify(surface: NamedFile, mesh: NamedFile, options?: VerifyOptions): Verdict;
}

/** Compiles the module: beside this file, or given as bytes, a URL, or a compiled module. */
export declare function load(source?: string | URL | BufferSource | WebAssembly.Module): Promise<Delmesher>;
/** The same of the module that verifies. */
export declare function loadVerifier(source?: string | URL | BufferSource | WebAssembly.Module): Promise<Verifier>;
