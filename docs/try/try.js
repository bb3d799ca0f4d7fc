// The page: a face of the commands `check`, `mesh` and `tetproof verify`, which run in a worker. What it says is what they say.
import { View, draw_legend } from "./view.js";
import { compile } from "./delmesher.js";
import { read_vtu } from "./vtu.js";

const $ = (id) => document.getElementById(id);
const kFormats = [".msh", ".vtu", ".inp"];
// As the command colours them (`delmesher check --defects`).
const kColours = {
  "self-intersection": [0.86, 0.16, 0.16], "open edge": [0.98, 0.59, 0.12], "non-manifold edge": [0.59, 0.24, 0.75],
  "non-manifold vertex": [0.59, 0.24, 0.75], "inconsistent orientation": [0.2, 0.35, 0.86],
  "degenerate triangle": [0.16, 0.63, 0.27], "duplicate triangle": [0.16, 0.63, 0.27],
};

const kVerdicts = {
  exact: "this mesh fills your surface exactly.",
  rounded: "this mesh fills your surface, as closely as the numbers in a file can tell.",
  deviating: "the surface of this mesh is off yours by more than rounding.",
  undecided: "this file alone does not tell.",
  broken: "something that was promised of this mesh does not hold.",
};

// Compiled once; that of the oracles when somebody asks.
const modules = {};
const module_of = (name) => (modules[name] ??= compile(new URL(name, location.href)).catch((error) => {
  delete modules[name];
  throw error;
}));
module_of("delmesher.wasm").catch(() => {});  // said when somebody needs it
let worker, end_job, input, meshed;
const view = new View($("view"));
draw_legend($("colours"), $("degrees"));

/** Has something done by the worker; null if it was cancelled, or if another one took its place. */
async function run(name, job) {
  end_job?.();
  return new Promise((done) => {
    let left = false;
    const leave = (result) => {
      if (left) return;
      left = true;
      end_job = undefined;
      $("running").hidden = true;
      $("mesh").disabled = $("verify").disabled = false;
      done(result);
    };
    const end_worker = (result) => {
      worker?.terminate();
      worker = undefined;
      leave(result);
    };
    const fail = (error) => end_worker({ code: 6, out: "", error: error.message ?? "the worker ended", files: {} });
    end_job = () => end_worker(null);
    const start = (module) => {
      if (left) return;
      worker ??= new Worker("worker.js", { type: "module" });
      worker.onmessage = ({ data }) => {
        if (data.result) return leave(data.result);
        $("progress").textContent = data.progress;
        const share = data.progress.match(/(\d+) %/);
        if (share) $("bar").value = Number(share[1]);
        else $("bar").removeAttribute("value");
      };
      worker.onerror = fail;
      worker.postMessage({ module, ...job });
    };
    $("progress").textContent = `${job.args?.[0] ?? "verify"} ...`;
    $("bar").removeAttribute("value");
    $("running").hidden = false;
    $("mesh").disabled = $("verify").disabled = true;
    module_of(name).then(start).catch(fail);
  });
}

function say(text, bad = false) {
  $("text").textContent = text.trim();
  $("text").className = bad ? "bad" : "";
  $("said").hidden = text.trim() === "";
}

async function open(name, bytes) {
  input = { name, path: name.startsWith("-") ? `./${name}` : name, bytes };
  for (const id of ["example", "surface", "options", "downloads", "verdict", "cutting", "said"]) $(id).hidden = true;
  const result = await run("delmesher.wasm", { args: ["check", input.path, "--json", "--defects", "defects.vtu"], files: { [name]: bytes } });
  if (result === null) return say("cancelled");
  $("name").textContent = name;
  $("surface").hidden = false;
  $("defects").replaceChildren();
  $("hints").replaceChildren();
  $("state").className = result.code === 0 ? "good" : "bad";
  if (!result.out.startsWith("{") || result.files["defects.vtu"] === undefined) {
    $("state").textContent = "cannot be read";
    document.body.classList.remove("loaded");
    return say(result.error, true);
  }
  const report = JSON.parse(result.out);
  $("state").textContent = report.valid
    ? `a valid surface: ${report.triangles} triangles, ${report.vertices} vertices`
    : `not a valid surface: ${report.triangles} triangles, ${report.vertices} vertices`;
  list_defects(report);
  const vtu = read_vtu(result.files["defects.vtu"]);
  // The file's first comment numbers the kinds from 1.
  const kinds = new TextDecoder().decode(result.files["defects.vtu"].subarray(0, 1000)).match(/defect: ([^>]*) -->/)[1].split(", ").map((kind) => kind.slice(kind.indexOf(" ") + 1));
  document.body.classList.add("loaded");
  view.show_surface(vtu, (number) => kColours[kinds[number]], report.defects.flatMap((defect) => defect.points));
  $("options").hidden = false;
  show_command();
}

function list_defects(report) {
  for (const [kind, count] of Object.entries(report.defect_counts)) {
    const head = document.createElement("h3"), dot = document.createElement("i"), item = document.createElement("li");
    dot.style.background = `rgb(${(kColours[kind] ?? [0.86, 0.16, 0.16]).map((c) => Math.round(255 * c)).join(" ")})`;
    head.append(dot, `${kind}: ${count}`);
    item.append(head);
    for (const defect of report.defects.filter((one) => one.kind === kind)) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = defect.message;
      button.onclick = () => {
        const points = defect.points;
        if (points.length > 0) view.go_to([0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length));
      };
      item.append(button, document.createElement("br"));
    }
    $("defects").append(item);
  }
  for (const text of [...report.warnings, ...report.hints]) {
    const item = document.createElement("li");
    item.textContent = text;
    $("hints").append(item);
  }
}

function command() {
  const stem = input.path.replace(/(\.[^.]*)?(\.gz)?$/i, ""), args = ["mesh", input.path, ...kFormats.flatMap((format) => ["-o", stem + format])];
  for (const [id, option] of [["keep", "--surface"], ["size", "--size"], ["tolerance", "--tolerance"]]) {
    const value = $(id).value.trim();
    if (value !== "" && value !== "auto") args.push(`${option}=${value}`);
  }
  return args;
}

function show_command() {
  const quoted = (word) => (/^[\w.\/=+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  $("command").textContent = ["delmesher", ...command()].map(quoted).join(" ");
}

async function mesh() {
  $("downloads").hidden = $("verdict").hidden = $("said").hidden = true;
  const args = command(), result = await run("delmesher.wasm", { args, files: { [input.name]: input.bytes } });
  if (result === null) return say("cancelled");
  say(result.out + result.error, result.code !== 0);
  const files = Object.entries(result.files), vtu = files.find(([name]) => name.endsWith(".vtu"));
  if (vtu === undefined) return;
  $("files").replaceChildren(...files.map(([name, bytes]) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `${name.slice(name.lastIndexOf("."))}, ${size_text(bytes.length)}`;
    button.dataset.file = name;
    button.onclick = () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([bytes]));
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    };
    return button;
  }));
  $("downloads").hidden = $("cutting").hidden = false;
  const { points, cells } = read_vtu(vtu[1]), [name, bytes] = files.find(([path]) => path.endsWith(".msh"));
  meshed = { file: { name, bytes }, promised: ["mesh", ...args.filter((word) => /^--\w+=/.test(word))].join(" ") };
  view.take_mesh({ points, cells });
  $("cut").value = 500;
  cut();
}

async function verify() {
  const { file: mesh, promised } = meshed;
  $("verdict").hidden = $("said").hidden = true;
  const result = await run("tetproof.wasm", { verify: { surface: { name: input.name, bytes: input.bytes }, mesh, promised } });
  if (result === null) return say("cancelled");
  if (result.error !== undefined) return say(result.error, true);
  const { verdict, passed, reasons, unproven, report } = result, deviation = ["rounded", "deviating"].includes(verdict) ? ` At most ${report.deviation.toPrecision(2)} off.` : "";
  $("judged").replaceChildren(Object.assign(document.createElement("b"), { textContent: verdict }), `: ${kVerdicts[verdict]}${deviation}`);
  $("judged").className = passed ? "good" : "bad";
  $("reasons").replaceChildren(...reasons.map(({ oracle, text, place }) => {
    const item = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.textContent = `${oracle}: ${text}`;
    button.disabled = !place?.at;
    button.onclick = () => view.go_to(place.at);
    item.append(button);
    return item;
  }));
  const passes = report.oracles.filter(({ status }) => status === "pass").map(({ name, checked, checked_what }) => `${name} (${checked} ${checked_what})`);
  $("passes").textContent = `Judged by code of its own. Passed: ${passes.join(", ") || "nothing"}.`;
  const judged = report.scope ? `What was judged: ${report.scope}. ` : "";
  $("unproven").textContent = judged + (unproven.length > 0 ? `Not shown: ${unproven.join("; ")}.` : "");
  $("verdict").hidden = false;
  $("verdict").scrollIntoView({ block: "nearest" });
}

function size_text(bytes) {
  return bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

function cut() {
  view.cut_mesh($("axis").selectedIndex, $("cut").value / 1000);
}

$("choose").onclick = () => $("file").click();
$("file").onchange = async () => {
  const [file] = $("file").files;
  if (file) await open(file.name, new Uint8Array(await file.arrayBuffer()));
  $("file").value = "";
};
for (const button of document.querySelectorAll("[data-sample]")) {
  button.onclick = async () => {
    const name = button.dataset.sample, response = await fetch(`samples/${name}`);
    await open(name, new Uint8Array(await response.arrayBuffer()));
  };
}
document.addEventListener("dragover", (event) => {
  event.preventDefault();
  document.body.classList.add("over");
});
document.addEventListener("dragleave", () => document.body.classList.remove("over"));
document.addEventListener("drop", async (event) => {
  event.preventDefault();
  document.body.classList.remove("over");
  const [file] = event.dataTransfer.files;
  if (file) await open(file.name, new Uint8Array(await file.arrayBuffer()));
});
$("mesh").onclick = mesh;
$("verify").onclick = verify;
$("cancel").onclick = () => end_job?.();
for (const id of ["keep", "size", "tolerance"]) $(id).oninput = show_command;
$("axis").oninput = $("cut").oninput = cut;
