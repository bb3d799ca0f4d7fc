// Draws the charts that the report holds as data, with Chart.js, in the colours of the page.
"use strict";
const charts = (() => {
  // Told apart by people with any colour vision, and against light and dark grounds (after Okabe and Ito).
  const palette = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#8c6d46", "#8a8f94"];
  const drawn = [];
  const colours = new Map();

  // A mesher has one colour everywhere; a series is called after it, perhaps with a number in brackets.
  function colourOf(label) {
    const name = label.replace(/ \(\d+\)$/, "");
    if (!colours.has(name)) colours.set(name, palette[colours.size % palette.length]);
    return colours.get(name);
  }

  const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function axis(title, log, stacked, category) {
    return {
      type: log ? "logarithmic" : category ? "category" : "linear",
      stacked,
      title: { display: Boolean(title), text: title },
      beginAtZero: !log,
      max: stacked && !category ? 100 : undefined,
      ticks: { maxRotation: 60, autoSkipPadding: 6 },
    };
  }

  function dataset(spec, series) {
    const colour = colourOf(series.label);
    const bars = spec.kind === "bars" || spec.kind === "stacked";
    return {
      label: series.label,
      data: bars ? series.data : series.data.map(([x, y]) => ({ x, y })),
      names: series.names,
      backgroundColor: bars ? colour : colour + "b0",
      borderColor: colour,
      borderWidth: bars ? 0 : 2,
      pointRadius: spec.kind === "points" ? 3 : 0,
      pointHitRadius: 6,
      showLine: spec.kind !== "points",
      stepped: spec.kind === "steps",
    };
  }

  function diagonal(spec) {
    const values = spec.series.flatMap(s => s.data.flat()).filter(v => v > 0);
    const low = Math.min(...values), high = Math.max(...values);
    return { label: "equal", type: "line", data: [{ x: low, y: low }, { x: high, y: high }], borderColor: "#8a8f94",
             borderDash: [5, 4], borderWidth: 1, pointRadius: 0 };
  }

  function config(spec) {
    const bars = spec.kind === "bars" || spec.kind === "stacked", stacked = spec.kind === "stacked";
    const datasets = spec.series.map(s => dataset(spec, s));
    if (spec.diagonal && spec.series.some(s => s.data.length)) datasets.push(diagonal(spec));
    return {
      type: bars ? "bar" : spec.kind === "points" ? "scatter" : "line",
      data: { labels: bars ? spec.categories : undefined, datasets },
      options: {
        animation: false, responsive: true, maintainAspectRatio: false,
        parsing: bars ? undefined : false, normalized: !bars,
        interaction: { mode: bars ? "index" : "nearest", intersect: false },
        scales: { x: axis(spec.x, spec.logX, stacked, bars), y: axis(spec.y, spec.logY, stacked, false) },
        plugins: {
          legend: { position: "bottom", labels: { boxWidth: 12 } },
          tooltip: { callbacks: { afterLabel: item => item.dataset.names?.[item.dataIndex] } },
        },
      },
    };
  }

  function paint(chart) {
    const ink = css("--ink"), line = css("--line");
    chart.options.color = ink;
    for (const scale of Object.values(chart.options.scales)) {
      scale.ticks.color = ink;
      scale.title.color = ink;
      scale.grid = { color: line };
    }
    chart.update("none");
  }

  // Into an element of class "frame"; what stood there before goes.
  function draw(frame, spec) {
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

  return { draw, colourOf, css };
})();
