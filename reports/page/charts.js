// Draws the charts that the report holds as data, with Chart.js, in the colours of the page.
"use strict";
const charts = (() => {
  const drawn = [];
  const kDashes = [[], [7, 4], [2, 3], [9, 3, 2, 3]], kShapes = ["circle", "triangle", "rectRot", "rect"];
  const kNeutral = "#8a8f94";
  let styles = [];  // of series: colour in light pages, in dark pages, pattern (reports/series_style.h)

  const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const dark = () => matchMedia("(prefers-color-scheme: dark)").matches && !matchMedia("print").matches;

  function styleOf(series) {
    if (series.style === undefined) return { colour: kNeutral, pattern: 0 };
    const [light, inTheDark, pattern] = styles[series.style % styles.length];
    return { colour: dark() ? inTheDark : light, pattern };
  }

  // The filling of a bar: plain, or its colour with lines or dots of the ground.
  function filling({ colour, pattern }) {
    if (pattern === 0) return colour;
    const tile = document.createElement("canvas"), size = 8;
    tile.width = tile.height = size;
    const pen = tile.getContext("2d");
    pen.fillStyle = colour;
    pen.fillRect(0, 0, size, size);
    pen.fillStyle = pen.strokeStyle = css("--panel");
    pen.lineWidth = 1.6;
    const line = (x1, y1, x2, y2) => { pen.beginPath(); pen.moveTo(x1, y1); pen.lineTo(x2, y2); pen.stroke(); };
    if (pattern === 3) {
      for (const [x, y] of [[2, 2], [6, 6]]) { pen.beginPath(); pen.arc(x, y, 1.5, 0, 7); pen.fill(); }
    } else {
      for (const shift of [-size, 0, size]) {
        line(shift, size, shift + size, 0);
        if (pattern === 2) line(shift, 0, shift + size, size);
      }
    }
    return pen.createPattern(tile, "repeat");
  }

  function axis(title, log, stacked, category) {
    return {
      type: log ? "logarithmic" : category ? "category" : "linear",
      stacked,
      title: { display: Boolean(title), text: title },
      beginAtZero: !log,
      max: stacked && title === "%" ? 100 : undefined,
      // Every category has its label, turned where it must be.
      ticks: { maxRotation: 75, autoSkip: !category, autoSkipPadding: 6 },
    };
  }

  function dataset(spec, series) {
    const bars = spec.kind === "bars" || spec.kind === "stacked";
    return {
      label: series.label,
      data: bars ? series.data : series.data.map(([x, y]) => ({ x, y })),
      names: series.names,
      series,
      borderWidth: bars ? 0 : 2,
      pointRadius: spec.kind === "points" ? 3.5 : 0,
      pointHitRadius: 6,
      showLine: spec.kind !== "points",
      stepped: spec.kind === "steps",
    };
  }

  function diagonal(spec) {
    const values = spec.series.flatMap(s => s.data.flat()).filter(v => v > 0);
    const low = Math.min(...values), high = Math.max(...values);
    return { label: "equal", type: "line", data: [{ x: low, y: low }, { x: high, y: high }], borderColor: kNeutral,
             backgroundColor: kNeutral, borderDash: [5, 4], borderWidth: 1, pointRadius: 0 };
  }

  function config(spec) {
    const bars = spec.kind === "bars" || spec.kind === "stacked", stacked = spec.kind === "stacked";
    const datasets = spec.series.map(s => dataset(spec, s));
    if (spec.diagonal && spec.series.some(s => s.data.length)) datasets.push(diagonal(spec));
    return {
      type: bars ? "bar" : spec.kind === "points" ? "scatter" : "line",
      data: { labels: bars ? spec.categories : undefined, datasets },
      options: {
        indexAxis: spec.flat ? "y" : "x",
        animation: false, responsive: true, maintainAspectRatio: false,
        parsing: bars ? undefined : false, normalized: !bars,
        interaction: { mode: bars ? "index" : "nearest", intersect: false },
        scales: spec.flat
          ? { x: axis(spec.y, spec.logY, stacked, false), y: axis("", false, stacked, true) }
          : { x: axis(spec.x, spec.logX, stacked, bars), y: axis(spec.y, spec.logY, stacked, false) },
        plugins: {
          legend: { position: "bottom", labels: bars ? { boxWidth: 14 } : { boxWidth: 30, usePointStyle: true,
            pointStyle: spec.kind === "points" ? undefined : "line" } },
          tooltip: { callbacks: { afterLabel: item => item.dataset.names?.[item.dataIndex] } },
        },
      },
    };
  }

  function paint(chart) {
    const ink = css("--ink"), line = css("--line");
    chart.options.color = ink;
    for (const one of chart.data.datasets) {
      if (!one.series) continue;
      const style = styleOf(one.series);
      one.borderColor = style.colour;
      one.borderDash = chart.config.type === "line" ? kDashes[style.pattern] : undefined;
      one.pointStyle = chart.config.type === "scatter" ? kShapes[style.pattern] : "line";
      one.backgroundColor = chart.config.type === "bar" ? filling(style) : style.colour + "b0";
    }
    for (const scale of Object.values(chart.options.scales)) {
      scale.ticks.color = ink;
      scale.title.color = ink;
      scale.grid = { color: line };
    }
    chart.update();  // with "none" Chart.js 3 keeps the colours that bars had
  }

  // Gives a frame the room that its chart will need.
  function reserve(frame, spec) {
    frame.style.setProperty("--series", Math.max(spec.series.length, 1));
    frame.style.setProperty("--bars", spec.flat ? spec.categories.length : 0);
    frame.classList.toggle("flat", Boolean(spec.flat));
  }

  // Into an element of class "frame"; what stood there before goes.
  function draw(frame, spec) {
    reserve(frame, spec);
    const old = drawn.findIndex(d => d.frame === frame);
    if (old >= 0) drawn.splice(old, 1)[0].chart.destroy();
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", spec.title + "; the numbers are in the CSV files beside this page");
    frame.replaceChildren(canvas);
    const chart = new Chart(canvas, config(spec));
    paint(chart);
    drawn.push({ frame, chart });
    return chart;
  }

  const repaint = () => drawn.forEach(d => paint(d.chart));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
  // Printed pages are light and of another width.
  const resize = () => { repaint(); drawn.forEach(d => d.chart.resize()); };
  addEventListener("beforeprint", resize);
  addEventListener("afterprint", resize);

  return { draw, reserve, css, use: table => { styles = table; } };
})();
