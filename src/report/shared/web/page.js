// Draws the plots of a report with uPlot, links their zoom, writes CSV. Words and tables are in the page already.
"use strict";
(() => {
  const plots = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const colour = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
  const dash = { measured: [], reference: [6, 4], named: [], other: [2, 3], input: [] };
  const dashed = (series) => !series.points && dash[series.role].length > 0;

  // Plots of one group share the range of x; a plot without a group is a group of its own.
  const groups = new Map();
  const group_of = (key) => {
    if (!groups.has(key)) groups.set(key, { charts: new Set(), range: null, busy: false });
    return groups.get(key);
  };
  const drawn = new Map();  // element -> { chart, group }

  // All of a chart: dots at its ends are whole.
  const all = (chart) => {
    const x = chart.data[0], first = x[0], last = x[x.length - 1], room = chart.dots ? 0.02 * (last - first) : 0;
    return { min: first - room, max: last + room };
  };

  function zoom(group, range) {  // range null: all
    group.range = range;
    group.busy = true;
    for (const chart of group.charts) chart.setScale("x", range ? { min: range[0], max: range[1] } : all(chart));
    group.busy = false;
  }

  const short = (value) => (value == null ? "" : Number(value.toPrecision(5)).toString());

  // Range of y: the data, and the marks no farther from it than it spans. A mark beyond is said at the edge.
  const range_with = (list) => (u, min, max) => {
    if (min == null) return [null, null];
    const span = max - min || Math.abs(max) || 1;
    let low = min, high = max;
    for (const { at } of list) if (at >= min - span && at <= max + span) { low = Math.min(low, at); high = Math.max(high, at); }
    return uPlot.rangeNum(low, high, 0.1, true);
  };

  // Room at the right for the words of the levels: inside the plot they would hide data.
  const gutter = (plot) => {
    const words = (plot.ymarks || []).map((mark) => mark.label.length).filter(Boolean);
    return words.length ? 16 + 7 * Math.max(...words) : null;
  };

  // Lines across the plot, with their words; no word lies on another.
  const marks = (plot) => (u) => {
    const c = u.ctx, { left, top, width, height } = u.bbox, ratio = devicePixelRatio;
    const right = left + width, bottom = top + height, line = 14 * ratio, gap = 8 * ratio, edge = 4 * ratio;
    const taken = [], said = [];
    const hit = (box) => taken.find((t) => box.left < t.right && t.left < box.right && box.top < t.bottom && t.top < box.bottom);
    // From this place down by lines until it is free.
    const write = (words, x, y) => {
      if (!words) return;
      const box = { left: x, right: x + c.measureText(words).width, top: y, bottom: y + line };
      for (let other = hit(box), tries = 0; other && tries < 20; other = hit(box), ++tries) {
        box.top = other.bottom;
        box.bottom = box.top + line;
      }
      taken.push(box);
      said.push([words, box]);
    };
    const stroke = (x0, y0, x1, y1) => { c.beginPath(); c.moveTo(x0, y0); c.lineTo(x1, y1); c.stroke(); };
    c.save();
    c.strokeStyle = c.fillStyle = colour("text");
    c.lineWidth = ratio;
    c.setLineDash([4 * ratio, 3 * ratio]);
    c.font = 12 * ratio + "px system-ui, sans-serif";
    c.textAlign = "left";
    const levels = [];  // words beside the plot, from the top down
    for (const { at, label } of plot.ymarks || []) {
      const y = u.valToPos(at, "y", true), out = y < top ? "\u2191 " : y > bottom ? "\u2193 " : "";
      if (!out) stroke(left, y, right, y);
      if (!label) continue;
      const words = out ? [out + label, short(Number(at.toPrecision(3)))] : [label];
      levels.push({ words, tall: words.length * line, y: y < top ? top : y > bottom ? bottom - 2 * line : y - line / 2 });
    }
    levels.sort((a, b) => a.y - b.y);
    let free = top - line;
    for (const level of levels) { level.y = Math.max(level.y, free); free = level.y + level.tall; }
    free = bottom + line;
    for (const level of levels.reverse()) { level.y = Math.min(level.y, free - level.tall); free = level.y; }
    for (const mark of plot.xmarks || []) {
      const at = u.valToPos(mark.at, "x", true), long = c.measureText(mark.label).width;
      if (at < left || at > right) continue;
      stroke(at, top, at, bottom);
      write(mark.label, right - at > long + gap ? at + edge : at - edge - long, top);
    }
    for (const [words, box] of said) {  // after all lines: none strikes a word through
      c.fillStyle = colour("card");
      c.fillRect(box.left - edge / 2, box.top, box.right - box.left + edge, line);
      c.fillStyle = colour("text");
      c.fillText(words, box.left, box.bottom - edge);
    }
    for (const { words, y } of levels)
      words.forEach((text, k) => c.fillText(text, right + edge, y + (k + 1) * line - edge));
    c.restore();
  };

  function options(plot, element, group, key) {
    const dense = plot.data[0].length > 4000;
    const series = [{ label: plot.x, value: (u, v) => short(v) }];
    for (const s of plot.series)
      series.push({
        label: s.name,
        stroke: colour(s.role),
        // Measured is drawn first, so its rim has to stay in sight. Beyond one pixel a long line takes ten times as long
        // to paint (docs/performance.md).
        width: dense ? 1 / devicePixelRatio : s.role === "measured" && plot.series.length > 1 ? 2.5 : 1.5,
        dash: dash[s.role],
        value: (u, v) => short(v),
        spanGaps: false,
        paths: s.points ? () => null : undefined,
        points: s.points ? { show: true, size: 7, fill: colour(s.role) } : { show: false },
      });
    const bands = [];
    if (plot.band) {
      const n = series.length;
      const edge = { stroke: "transparent", points: { show: false }, value: (u, v) => "\u00b1" + short(v) };
      series.push({ ...edge, label: plot.band, class: "lower" }, { ...edge, label: plot.band, class: "band" });
      bands.push({ series: [n + 1, n], fill: colour("band") });
    }
    // Without words below the axis its last tick carries the unit.
    const unit = plot.x_shown ? null : / \[(.+)\]$/.exec(plot.x || "")?.[1];
    const ticks_x = unit ? (u, ticks) => ticks.map((v, k) => short(v) + (k === ticks.length - 1 ? " " + unit : "")) : undefined;
    const axis = { stroke: colour("muted"), grid: { stroke: colour("grid"), width: 1 }, ticks: { stroke: colour("grid"), width: 1 }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" };
    return {
      width: element.clientWidth,
      height: (plot.low ? 140 : 200) * ("print" in root.dataset ? 0.8 : 1),
      series, bands,
      padding: [null, gutter(plot), null, null],
      scales: { x: plot.log_x ? { time: false, distr: 3, range: (u, min, max) => [min, max] } : { time: false }, y: plot.log ? { distr: 3 } : { range: range_with(plot.ymarks || []) } },
      axes: [
        { ...axis, label: plot.x_shown ? plot.x : null, labelSize: 16, size: 30, values: ticks_x },
        { ...axis, space: 26, size: (u, ticks) => Math.max(u.width < 520 ? 48 : 64, 16 + 7 * Math.max(0, ...(ticks || []).map((t) => String(t ?? "").length))), values: plot.log ? undefined : (u, ticks) => ticks.map((v) => short(v)) },
      ],
      cursor: {
        drag: { x: true, y: false },
        sync: key ? { key, scales: ["x", null], filters: { pub: (type) => !/^mouse(down|up)$|^dblclick$/.test(type) } } : undefined,
      },
      // A box that is filled: an empty one looks as if its series were missing. What is dashed has a dashed rim.
      legend: { markers: {
        fill: (u, i) => (i > 0 && i <= plot.series.length && !dashed(plot.series[i - 1]) ? colour(plot.series[i - 1].role) : null),
        dash: (u, i) => (i > 0 && i <= plot.series.length && dashed(plot.series[i - 1]) ? "dashed" : "solid"),
      } },
      hooks: {
        draw: [marks(plot)],
        setLegend: [(u) => u.root.classList.toggle("told", u.legend.idx != null)],
        setScale: [(u, scale) => {
          if (scale !== "x" || group.busy || u.status !== 1) return;
          const { min, max } = u.scales.x, x = u.data[0];
          zoom(group, min <= x[0] && max >= x[x.length - 1] ? null : [min, max]);
        }],
      },
    };
  }

  function draw(element) {
    const number = element.parentElement.dataset.plot, plot = plots[number];
    const key = plot.group ? "g:" + plot.group : "";
    const group = group_of(key || "p:" + number);
    erase(element);
    const chart = new uPlot(options(plot, element, group, key), plot.data, element);
    chart.dots = plot.series.some((s) => s.points);
    group.charts.add(chart);
    drawn.set(element, { chart, group });
    if (group.range || chart.dots) {
      group.busy = true;
      chart.setScale("x", group.range ? { min: group.range[0], max: group.range[1] } : all(chart));
      group.busy = false;
    }
    for (const th of chart.root.querySelectorAll(".u-legend .u-series th")) {
      th.tabIndex = 0;
      th.setAttribute("role", "button");
      th.addEventListener("keydown", (e) => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); e.stopPropagation(); th.click(); } });
    }
  }

  function erase(element) {
    const old = drawn.get(element);
    if (!old) return;
    old.group.charts.delete(old.chart);
    old.chart.destroy();
    drawn.delete(element);
  }

  const charts = [...document.querySelectorAll(".chart")];
  const redraw = () => { for (const element of [...drawn.keys()]) draw(element); };

  // Keys on a focused chart: + and - zoom about the middle, arrows move by a quarter, 0 shows all.
  function step(element, key) {
    const { chart, group } = drawn.get(element) || {};
    if (!chart) return false;
    const x = chart.data[0], first = x[0], last = x[x.length - 1];
    const [min, max] = group.range || [first, last];
    const span = max - min, middle = (min + max) / 2;
    const to = (a, b) => { zoom(group, a <= first && b >= last ? null : [Math.max(a, first), Math.min(b, last)]); return true; };
    switch (key) {
      case "+": case "=": return to(middle - span / 4, middle + span / 4);
      case "-": return to(middle - span, middle + span);
      case "0": case "Home": zoom(group, null); return true;
      case "ArrowLeft": { const d = Math.min(span / 4, min - first); return to(min - d, max - d); }
      case "ArrowRight": { const d = Math.min(span / 4, last - max); return to(min + d, max + d); }
    }
    return false;
  }

  for (const element of charts)
    element.addEventListener("keydown", (e) => {
      if (!e.ctrlKey && !e.metaKey && !e.altKey && step(element, e.key)) e.preventDefault();
    });

  // Buttons that do the same, above the first chart of each section.
  for (const part of document.querySelectorAll(".part")) {
    const first = part.querySelector(".chart");
    if (!first) continue;
    const tools = document.createElement("div");
    tools.className = "tools";
    for (const [key, label] of [["+", "Zoom in"], ["-", "Zoom out"], ["ArrowLeft", "Left"], ["ArrowRight", "Right"], ["0", "Show all"]]) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      button.addEventListener("click", () => step(first, key));
      tools.append(button);
    }
    tools.append("or drag across a chart; a double click shows all");
    first.parentElement.before(tools);
  }

  // Drawn when they come near the screen: a page of many logs opens at once.
  const near = new IntersectionObserver((entries) => {
    for (const entry of entries)
      if (entry.isIntersecting && !drawn.has(entry.target) && entry.target.clientWidth > 0) draw(entry.target);
  }, { rootMargin: "600px" });
  for (const element of charts) near.observe(element);

  let pending = 0;
  new ResizeObserver(() => {
    cancelAnimationFrame(pending);
    pending = requestAnimationFrame(() => {
      // In place: a chart taken down and drawn anew makes the page shorter for a moment, a scroll bar goes, and all are
      // wider again; that never ended.
      for (const [element, { chart }] of drawn) {
        const width = element.clientWidth;
        if (width > 0 && width !== chart.width) chart.setSize({ width, height: chart.height });
      }
    });
  }).observe(document.body);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

  // On paper: light, everything open, at the paper's width.
  addEventListener("beforeprint", () => {
    root.dataset.print = "";
    for (const fold of document.querySelectorAll("details:not([open])")) { fold.open = true; fold.dataset.opened = ""; }
    for (const element of charts) { element.style.width = "680px"; draw(element); }
  });
  addEventListener("afterprint", () => {
    delete root.dataset.print;
    for (const fold of document.querySelectorAll("details[data-opened]")) { fold.open = false; delete fold.dataset.opened; }
    for (const element of charts) element.style.width = "";
    redraw();
  });

  // Long tables show their first rows.
  for (const figure of document.querySelectorAll("[data-shown]")) {
    const rows = [...figure.querySelectorAll("tbody tr")].slice(Number(figure.dataset.shown));
    for (const row of rows) row.dataset.folded = "";
    const more = document.createElement("button");
    more.type = "button";
    more.className = "more";
    more.textContent = `Show ${rows.length} more`;
    more.addEventListener("click", () => { for (const row of rows) delete row.dataset.folded; more.remove(); });
    figure.append(more);
  }

  // CSV: of a plot the columns as drawn, of a table the numbers behind its cells. A word that a spreadsheet would take
  // for a formula gets an apostrophe.
  const quoted = (text) => {
    const safe = /^[=+@\t\r]|^-\D/.test(text) ? "'" + text : text;
    return /[",\n\r]/.test(safe) ? '"' + safe.replaceAll('"', '""') + '"' : safe;
  };
  function csv(figure) {
    if (figure.dataset.plot !== undefined) {
      const plot = plots[figure.dataset.plot];
      const names = [plot.x, ...plot.series.map((s) => s.name)];
      if (plot.band) names.push(plot.band + " lower", plot.band + " upper");
      const rows = plot.data[0].map((_, k) => plot.data.map((column) => column[k] ?? "").join(","));
      return names.map(quoted).join(",") + "\n" + rows.join("\n") + "\n";
    }
    const lines = [];
    for (const row of figure.querySelectorAll("tr"))
      lines.push([...row.cells].filter((cell) => !cell.classList.contains("bar"))
        .map((cell) => cell.dataset.value || quoted(cell.textContent.trim())).join(","));
    return lines.join("\n") + "\n";
  }
  for (const button of document.querySelectorAll(".csv"))
    button.addEventListener("click", () => {
      const figure = button.closest("figure");
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([csv(figure)], { type: "text/csv" }));
      link.download = button.getAttribute("aria-label").slice("CSV of ".length).replace(/[^\w.-]+/g, "_") + ".csv";
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });

  // For tests and for the curious at the console.
  window.servodx = { drawn, groups, csv, step };
})();
