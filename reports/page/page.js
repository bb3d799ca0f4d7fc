// Brings the page to life: charts, the comparison of two meshers, the page of a model, the gallery.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const columns = Object.fromEntries(data.columns.map((name, i) => [name, i]));
  const $ = id => document.getElementById(id);
  const get = (run, name) => run[columns[name]];
  const runs = new Map();  // by model and mesher
  for (const run of data.runs) runs.set(get(run, "model") + " " + get(run, "mesher"), run);
  const runOf = (model, mesher) => runs.get(model + " " + mesher);
  const available = { charts: data.charts_drawn, pictures: data.pictures_drawn };  // libraries of this build
  charts.use(data.styles);
  const isOk = run => run && get(run, "disposition") === "ok" && get(run, "tetrahedra") !== null;

  function element(tag, text, attributes = {}) {
    const e = document.createElement(tag);
    if (text !== undefined && text !== null) e.textContent = text;
    Object.assign(e, attributes);
    return e;
  }

  function fill(select, items) {
    select.replaceChildren(...items.map(([value, text]) => element("option", text, { value })));
  }

  // The charts that need nothing but their data. Those out of sight wait until they come near.
  const specs = new Map(data.charts.map(c => [c.name, c]));
  const near = new IntersectionObserver(entries => entries.forEach(e => {
    if (!e.isIntersecting) return;
    near.unobserve(e.target);
    charts.draw(e.target, specs.get(e.target.dataset.chart));
  }), { rootMargin: "1500px" });
  document.querySelectorAll(".frame[data-chart]").forEach(frame => {
    charts.reserve(frame, specs.get(frame.dataset.chart));
    near.observe(frame);
  });
  addEventListener("beforeprint", () => document.querySelectorAll(".frame[data-chart]").forEach(frame => {
    if (frame.firstChild === null) charts.draw(frame, specs.get(frame.dataset.chart));
  }));

  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach(d => { d.open = true; }));

  // Two meshers against each other on their common models.
  const measures = {
    "wall_seconds": { text: "seconds", log: true },
    "tetrahedra": { text: "tetrahedra", log: true },
    "peak_mb": { text: "peak memory, MB", log: true },
    "min_face_angle": { text: "smallest face angle, degrees", log: false },
    "mean_min_face_angle": { text: "average smallest face angle, degrees", log: false },
    "mean_min_dihedral": { text: "average smallest dihedral angle, degrees", log: false },
  };

  function compare() {
    const first = Number($("first").value), second = Number($("second").value), what = $("measure").value;
    const names = [first, second].map(i => data.meshers[i]), log = measures[what].log;
    const points = [], labels = [], differences = [];
    let unlike = 0;  // a hull beside an interior
    data.models.forEach((model, m) => {
      const a = runOf(m, first), b = runOf(m, second);
      if (!isOk(a) || !isOk(b)) return;
      const x = get(a, what), y = get(b, what);
      if (x === null || y === null || (log && (x <= 0 || y <= 0))) return;
      points.push([x, y]);
      labels.push(model.name);
      unlike += get(a, "region") !== get(b, "region");
      differences.push(log ? y / x : y - x);
    });
    charts.draw($("scatter"), { title: measures[what].text, kind: "points", logX: log, logY: log, diagonal: true,
      x: `${names[0]}: ${measures[what].text}`, y: `${names[1]}: ${measures[what].text}`,
      series: [{ label: `${names[1]} against ${names[0]}`, style: second, data: points, names: labels }] });
    differences.sort((a, b) => a - b);
    const quantiles = differences.map((d, i) => [100 * (i + 0.5) / differences.length, d]);
    charts.draw($("quantiles"), { title: "quantiles", kind: "lines", logY: log, x: "% of the common models",
      y: log ? `${names[1]} / ${names[0]}` : `${names[1]} - ${names[0]}`,
      series: [{ label: `${names[1]} against ${names[0]}`, style: second, data: quantiles },
               { label: log ? "equal (1)" : "equal (0)", data: [[0, log ? 1 : 0], [100, log ? 1 : 0]] }] });
    $("common").textContent = `${points.length} models on which both succeed` +
      (unlike > 0 ? `; of ${unlike} one mesh is of the hull, the other of the interior` : "");
  }

  function startComparison() {
    if (data.meshers.length < 2 || $("first") === null) return;
    const meshers = data.meshers.map((name, i) => [i, name]);
    fill($("first"), meshers);
    fill($("second"), meshers);
    fill($("measure"), Object.entries(measures).map(([key, m]) => [key, m.text]));
    const preferred = data.pair.map(name => data.meshers.indexOf(name));
    $("first").value = preferred[0];
    $("second").value = preferred[1];
    for (const id of ["first", "second", "measure"]) $(id).addEventListener("change", compare);
    compare();
  }

  // One model: all its runs, and what can be seen of it.
  const parts = new Map();  // by model, in the order of the page
  document.querySelectorAll("script.part").forEach(script => {
    const part = JSON.parse(script.textContent);
    if (!parts.has(part.model)) parts.set(part.model, []);
    parts.get(part.model).push(part);
  });
  let view = null, model = 0;

  function number(value, digits) {
    return value === null || value === undefined ? "-" : Number(value).toFixed(digits);
  }

  function runRow(mesher, run) {
    const row = element("tr"), disposition = get(run, "disposition"), verdict = get(run, "verdict") || "-";
    const colour = { ok: "ok", unverified: "unverified" }[disposition] || "not-ok";
    row.append(element("td"));
    row.lastChild.append(element("span", data.meshers[mesher], { className: "whole" }));
    row.append(element("td", disposition, { className: "text " + colour }));
    row.append(element("td", verdict, { className: verdict.length > 30 ? "text prose" : "text" }));
    for (const [name, digits] of [["wall_seconds", 2], ["verify_seconds", 2], ["peak_mb", 0], ["vertices", 0], ["tetrahedra", 0],
                                  ["min_face_angle", 3], ["max_face_angle", 2], ["min_dihedral", 3],
                                  ["max_dihedral", 2], ["mean_min_face_angle", 1], ["mean_min_dihedral", 1]]) {
      const hull = ["vertices", "tetrahedra"].includes(name) && get(run, "region") === "hull";
      row.append(element("td", number(get(run, name), digits) + (hull ? " (hull)" : "")));
    }
    const reason = get(run, "reason"), how = element("td", undefined, { className: reason ? "text prose" : "text" });
    if (reason) how.append(element("div", reason));
    const fold = element("details", undefined, { className: "fold" });
    fold.append(element("summary", "command"), element("code", get(run, "command")));
    how.append(fold);
    row.append(how);
    return row;
  }

  function phaseChart() {
    const names = data.phases, series = names.map((label, style) => ({ label, style, data: [] })), categories = [];
    data.meshers.forEach((mesher, i) => {
      const run = runOf(model, i), seconds = run && get(run, "phases");
      if (!seconds) return;
      categories.push(mesher);
      names.forEach((name, p) => series[p].data.push(seconds[p]));
    });
    const shown = series.filter(s => s.data.some(v => v > 0));
    $("model-phases").parentElement.hidden = categories.length === 0;
    if (categories.length > 0) {
      charts.draw($("model-phases"), { title: "Seconds by phase", kind: "stacked", flat: true, x: "", y: "seconds", categories,
                                       series: shown });
    }
  }

  function histogramChart(id, column, title) {
    const series = [];
    data.meshers.forEach((mesher, i) => {
      const run = runOf(model, i), bins = run && get(run, column);
      if (bins) series.push({ label: mesher, style: i, data: bins });
    });
    $(id).parentElement.hidden = series.length === 0;
    if (series.length === 0) return;
    const categories = series[0].data.map((_, i) => `${15 * i}-${15 * i + 15}`);
    charts.draw($(id), { title, kind: "bars", x: "degrees", y: "% of angles", categories, series });
  }

  function showPart() {
    const list = parts.get(model);
    const part = list && list[Number($("part").value)];
    if (!part) return;
    const share = Number($("cut").value) / 100;
    const look = { axis: Number($("axis").value), cut: 2.02 * share - 1.01, bad: Number($("bad").value),
                   insideOnly: $("inside").checked, edges: $("edges").checked };
    $("bad-value").textContent = look.bad;
    view = view || views.open($("view"));
    view.show(part, look, data.models[model].name);
  }

  function showModel(index) {
    model = index;
    const m = data.models[index];
    $("model").value = index;
    $("model-name").textContent = m.name;
    $("model-facts").textContent = `SHA-256 ${m.sha256}, ${m.bytes} bytes`;
    $("model-runs").replaceChildren(...data.meshers.flatMap((_, i) => runOf(index, i) ? [runRow(i, runOf(index, i))] : []));
    $("model-charts").hidden = !available.charts;
    if (available.charts) {
      phaseChart();
      histogramChart("model-faces", "face_histogram", "Face angles");
      histogramChart("model-dihedrals", "dihedral_histogram", "Dihedral angles");
    }
    const list = parts.get(index) || [];
    $("model-3d").hidden = list.length === 0;
    $("model-no-3d").hidden = list.length > 0;
    $("model-no-3d").textContent = !available.pictures ? "No pictures: this build lacks three.js."
      : "No picture of this model" + (parts.size > 0 ? " (those with \u25c6 have some)" : "") +
        ": meshes are there after run --keep, of as many models as report --views says.";
    if (list.length === 0) return;
    fill($("part"), list.map((part, i) => [i, part.label]));
    $("part").value = bestPart(list);
    showPart();
  }

  // What was looked at before, if this model has it; else our mesh, else any.
  let looked = null;
  function bestPart(list) {
    const same = looked === null ? -1 : list.findIndex(p => p.label === looked);
    if (same >= 0) return same;
    const ours = list.findIndex(p => p.kind === "mesh" && p.ours);
    return Math.max(0, ours >= 0 ? ours : list.findIndex(p => p.kind === "mesh"));
  }

  function startModels() {
    if ($("model") === null || data.models.length === 0) return;
    fill($("model"), data.models.map((m, i) => [i, (parts.has(i) ? "◆ " : "") + m.name]));
    $("model").addEventListener("change", () => { location.hash = "model=" + data.models[$("model").value].sha256.slice(0, 12); });
    $("part").addEventListener("input", () => { looked = (parts.get(model) || [])[Number($("part").value)].label; });
    for (const id of ["part", "axis", "cut", "bad", "inside", "edges"]) $(id).addEventListener("input", showPart);
    const follow = scroll => {
      const wanted = /^#model=([0-9a-f]+)/.exec(location.hash);
      const found = wanted ? data.models.findIndex(m => m.sha256.startsWith(wanted[1])) : -1;
      if (found >= 0) showModel(found);
      if (found >= 0 && scroll) $("models").scrollIntoView();
      return found >= 0;
    };
    addEventListener("hashchange", () => follow(true));
    if (!follow(true)) showModel(parts.size > 0 ? parts.keys().next().value : 0);
  }

  // Figure 9: input, mesh cut open, and what is inside.
  function startGallery() {
    const gallery = $("gallery");
    if (gallery === null || parts.size === 0) return;
    for (const [index, list] of parts) {
      const input = list.find(p => p.label === "input");
      const meshes = list.filter(p => p.kind === "mesh");
      const find = test => meshes.find(p => p.ours && test(p)) || meshes.find(p => p.ours) || meshes.find(test) || meshes[0];
      const whole = find(p => p.hull), inner = find(p => !p.hull);
      const figure = element("figure"), caption = element("figcaption"), row = element("div", undefined, { className: "shots" });
      const link = element("a", data.models[index].name, { href: "#model=" + data.models[index].sha256.slice(0, 12) });
      caption.append(link);
      const shown = [[input, {}], [whole, { cut: 0.02 }]];
      if (inner !== whole || (whole && whole.hull)) shown.push([inner, { cut: 0.02, insideOnly: true }]);
      figure.append(caption, row);
      gallery.append(figure);
      for (const [part, look] of shown.filter(([p]) => p)) {
        const shot = element("div", undefined, { className: "shot" }), canvas = element("canvas");
        shot.append(canvas);
        row.append(shot);
        const cut = views.picture(canvas, part, { bad: 5, ...look });
        const what = part.kind !== "mesh" ? part.label
          : part.label + (look.insideOnly && part.hull ? ", inside" : part.hull ? ", all" : "") + (cut ? "" : ", not cut");
        shot.append(element("div", what, { className: part.ours ? "ours" : "" }));
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", `${data.models[index].name}: ${what}`);
      }
    }
  }

  // Heat maps: cells coloured by what they say, columns sorted by a click on their head.
  function startHeatMaps() {
    const dispositions = ["unverified", "wrong-result", "rejected", "crash", "timeout", "out-of-memory", "killed"];
    document.querySelectorAll("table.heat").forEach(table => {
      const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
      const text = (row, i) => row.cells[i].textContent;
      for (const row of body.rows) {
        for (const cell of [...row.cells].slice(3)) {
          const said = cell.textContent, seconds = Number(said);
          cell.className = said === "-" ? "" : said === "wrong-result" ? "wrong" : Number.isNaN(seconds) ? "none"
            : seconds < 1 ? "fast" : "slow";
        }
      }
      // Numbers first, then dispositions in their order, then other words.
      const rank = said => {
        const number = Number(said), place = dispositions.indexOf(said);
        return !Number.isNaN(number) ? [0, number] : place >= 0 ? [1, place] : [2, 0];
      };
      heads.forEach((head, i) => {
        let sign = -1;
        head.addEventListener("click", () => {
          sign = -sign;
          body.replaceChildren(...[...body.rows].sort((a, b) => {
            const [x, y] = [rank(text(a, i)), rank(text(b, i))];
            return sign * (x[0] - y[0] || x[1] - y[1] || (x[0] === 2 ? text(a, i).localeCompare(text(b, i)) : 0));
          }));
        });
      });
    });
  }

  function attempt(what) {
    try {
      what();
    } catch (error) {
      console.error(error);
      $("trouble").hidden = false;
      $("trouble").textContent = "A part of this page could not be drawn: " + error.message;
    }
  }
  [startComparison, startGallery, startModels, startHeatMaps].forEach(attempt);
  document.body.dataset.ready = "yes";
})();
