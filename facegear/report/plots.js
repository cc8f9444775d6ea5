// Draws the figures of the page that have an interactive form with plotly.js, both packed inside it (facegear/report/page.py).
"use strict";
(() => {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const NARROW = 480, PHONE = 400; // px of a figure below which titles of panels are smaller, and its legend is higher
  const ranges = new Map();
  let library = null, specs = null;

  async function load() {
    specs = JSON.parse(await unpacked(document.getElementById("plot-figures")));
    const script = document.createElement("script");
    script.textContent = await unpacked(document.getElementById("plot-library"));
    document.head.append(script);
    library = window.Plotly;
  }

  // in the dark, black and grey change places with white, and dim lines are lightened; areas keep the colours of their scale
  function seen(colour, area) {
    const parts = colour.startsWith("#")
      ? [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16))
      : (colour.match(/[\d.]+/g) || []).map(Number);
    const [r, g, b, alpha] = parts;
    if (!dark.matches) return colour;
    const grey = Math.max(r, g, b) - Math.min(r, g, b) <= 24, dim = !area && 0.3 * r + 0.6 * g + 0.1 * b < 95;
    if (!grey && !dim) return colour;
    const turned = [r, g, b].map((part) => Math.round(grey ? 235 - 0.85 * part : part + 0.4 * (255 - part)));
    return `rgba(${turned.join(",")},${alpha === undefined ? 1 : alpha})`;
  }

  function themed(part, key = "", area = false) {
    if (typeof part === "string") return /colou?r$/.test(key) && /^(#|rgba?\()/.test(part) ? seen(part, area) : part;
    if (Array.isArray(part)) {
      if (key === "colorscale" || typeof part[0] === "number") return part;
      return part.map((item) => themed(item, key, area));
    }
    if (part === null || typeof part !== "object") return part;
    const filled = area || "fillcolor" in part;
    return Object.fromEntries(Object.entries(part).map(([name, item]) => [name, themed(item, name, filled)]));
  }

  // on a narrow screen a title of a panel would end outside the figure
  function narrow(layout) {
    for (const note of layout.annotations || [])
      if (/domain$/.test(note.xref) && /domain$/.test(note.yref)) note.font = { ...note.font, size: 11 };
  }

  function layoutOf(spec, width) {
    const layout = themed(spec.layout), grid = style("--rule");
    for (const [name, axis] of Object.entries(layout)) {
      if (!/^[xy]axis/.test(name)) continue;
      Object.assign(axis, { gridcolor: grid, linecolor: style("--quiet"), zeroline: false, ticks: "outside", tickcolor: grid });
      axis.title.font = { size: 12 };
      axis.exponentformat = axis.type === "log" ? "power" : "none";
      const kept = ranges.get(axis.title.text);
      if (name[0] === "x" && kept) axis.range = kept;
    }
    if (width < NARROW) narrow(layout);
    if (width < PHONE) layout.height += spec.narrow_px;
    return Object.assign(layout, {
      modebar: { bgcolor: "rgba(0,0,0,0)", color: style("--quiet"), activecolor: style("--text") },
      autosize: true, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { family: "system-ui, Segoe UI, Helvetica, Arial, sans-serif", size: 12, color: style("--text") },
      hoverlabel: { bgcolor: style("--card"), bordercolor: style("--rule"), font: { color: style("--text") } },
      dragmode: "zoom",
    });
  }

  const cell = (value) => (/[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : value ?? "");

  function csv(graph) {
    const lines = ["curve,x,y,value"];
    for (const trace of graph.data) {
      const rows = trace.y || [], columns = trace.x || [];
      if (trace.type === "heatmap")
        rows.forEach((y, i) => columns.forEach((x, j) => lines.push([trace.name, x, y, trace.z[i]?.[j]].map(cell).join(","))));
      else columns.forEach((x, i) => { if (x !== null) lines.push([trace.name, x, rows[i], trace.marker?.color?.[i]?.toFixed ? trace.marker.color[i] : ""].map(cell).join(",")); });
    }
    const link = document.createElement("a");
    link.download = `${graph.closest("figure").dataset.name}.csv`;
    link.href = URL.createObjectURL(new Blob([lines.join("\n")], { type: "text/csv" }));
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  // figures over the same speeds show the same range of them
  function link(graph, change) {
    for (const name of Object.keys(graph.layout).filter((name) => name.startsWith("xaxis"))) {
      const title = graph.layout[name].title?.text || "";
      const moved = Object.keys(change).some((key) => key.startsWith(`${name}.`));
      if (!moved || !/speed/i.test(title)) continue;
      const range = [...graph.layout[name].range];
      ranges.set(title, range);
      for (const other of document.querySelectorAll("figure[data-drawn] .live")) {
        if (other === graph) continue;
        for (const axis of Object.keys(other.layout || {}))
          if (axis.startsWith("xaxis") && other.layout[axis].title?.text === title && String(other.layout[axis].range) !== String(range))
            library.relayout(other, { [`${axis}.range`]: [...range] });
      }
    }
  }

  const config = {
    displaylogo: false, responsive: true, doubleClick: "reset",
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "zoomIn2d", "zoomOut2d"],
    modeBarButtonsToAdd: [{ name: "values", title: "Download the values (csv)", get icon() { return library.Icons.disk; }, click: csv }],
  };

  async function draw(figure) {
    const graph = figure.querySelector(".live"), spec = specs[figure.id];
    await library.newPlot(graph, themed(spec.data), layoutOf(spec, graph.clientWidth), config);
    graph.on("plotly_relayout", (change) => link(graph, change));
    figure.dataset.drawn = "true";
  }

  async function start() {
    await load();
    const figures = [...document.querySelectorAll("figure")].filter((figure) => specs[figure.id]);
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries)
        if (entry.isIntersecting) { watcher.unobserve(entry.target); draw(entry.target); }
    }, { rootMargin: "400px" });
    for (const figure of figures) {
      const { title, layout, narrow_px } = specs[figure.id], live = figure.querySelector(".live");
      figure.querySelector(".title").innerHTML = title;
      figure.classList.add("interactive");
      live.style.minHeight = `${layout.height + (live.clientWidth < PHONE ? narrow_px : 0)}px`; // nothing moves when it is drawn
      watcher.observe(figure);
    }
    dark.addEventListener("change", () => {
      for (const figure of document.querySelectorAll("figure[data-drawn]")) {
        const spec = specs[figure.id];
        const graph = figure.querySelector(".live");
        library.react(graph, themed(spec.data), layoutOf(spec, graph.clientWidth), config);
      }
    });
    document.documentElement.dataset.plots = "ready";
  }

  if (document.getElementById("plot-library") && window.DecompressionStream) start();
})();
