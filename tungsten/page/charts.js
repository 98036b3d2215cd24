// Plots (by uPlot): arrival histograms with their error band, and error against time.

const SERIES_COLOURS = ["#2f8fdd", "#e8720c", "#1a9e77", "#c05fa5", "#b39a00", "#8a6fd1", "#d64550", "#5aa6b8", "#8c6a4f",
                        "#7d8790"];
const seriesColour = (index) => SERIES_COLOURS[index % SERIES_COLOURS.length];
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Three significant digits, with an exponent only where that is shorter. */
function short(value) {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size < 1e5 && size >= 1e-3) return String(+value.toPrecision(3));
  return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
}

const FONT = '12px system-ui, "DejaVu Sans", sans-serif';

function axis(label, size) {
  return {
    label, labelSize: 20, size, font: FONT, labelFont: FONT, stroke: style("--ink"),
    grid: { stroke: style("--grid"), width: 1 }, ticks: { stroke: style("--line"), width: 1 },
    values: (_, splits) => splits.map((value) => (value === null ? "" : short(value))),
  };
}

/** Names with their colours, under a plot. */
function key(host, names) {
  const line = document.createElement("div");
  line.className = "row hint";
  for (const [name, colour] of names) {
    const entry = document.createElement("span"), swatch = document.createElement("i");
    swatch.className = "swatch";
    swatch.style.background = colour;
    entry.append(swatch, name);
    line.append(entry);
  }
  host.append(line);
}

function plotWidth(host) {
  return Math.max(260, host.clientWidth);
}

/** Histogram over time of the patch in every film given; a click on it goes to that frame. */
function drawHistogram(host, scene, films, patch, frame, onFrame) {
  host.replaceChildren();
  const { start, width } = scene.time, frames = films[0].frames;
  const data = [Float64Array.from({ length: frames + 1 }, (_, i) => start + i * width)];
  const stepped = uPlot.paths.stepped({ align: 1 });
  const series = [{}], bands = [];
  films.forEach((film, index) => {
    const bins = Array.from({ length: frames }, (_, i) => film.patch(i, patch));
    bins.push(bins[frames - 1]); // the last bin's right edge
    const colour = seriesColour(index);
    data.push(bins.map((bin) => bin.value));
    series.push({ label: film.name, stroke: colour, width: 1.5, paths: stepped, points: { show: false } });
    if (!film.hasError) return;
    data.push(bins.map((bin) => bin.value + bin.error), bins.map((bin) => Math.max(0, bin.value - bin.error)));
    const edge = { stroke: "transparent", paths: stepped, points: { show: false } };
    series.push(edge, { ...edge });
    bands.push({ series: [series.length - 2, series.length - 1], fill: `${colour}44` });
  });
  const now = (plot) => {
    const x = plot.valToPos(start + (host.frame + 0.5) * width, "x", true), { context: c = plot.ctx } = plot;
    c.save();
    c.strokeStyle = style("--ink");
    c.setLineDash([4, 4]);
    c.beginPath();
    c.moveTo(x, plot.bbox.top);
    c.lineTo(x, plot.bbox.top + plot.bbox.height);
    c.stroke();
    c.restore();
  };
  host.frame = frame;
  const options = {
    width: plotWidth(host), height: 250, series, bands, legend: { show: false },
    scales: { x: { time: false }, y: { range: (_, low, high) => [0, high > 0 ? 1.05 * high : 1] } },
    axes: [axis(`time since the pulse, in ${scene.time.unit || "the scene's unit"}`, 46), axis(scene.quantity, 66)],
    cursor: { drag: { x: false, y: false } }, hooks: { draw: [now] },
  };
  host.plot = new uPlot(options, data, host);
  host.plot.over.addEventListener("click", (event) => {
    const time = host.plot.posToVal(event.offsetX, "x");
    onFrame(Math.max(0, Math.min(frames - 1, Math.floor((time - start) / width))));
  });
  const alone = patch.x0 === patch.x1 && patch.y0 === patch.y1;
  const band = films.some((film) => film.hasError) ? ` (band: ± 1 standard error${alone ? "" : ", at most"})` : "";
  key(host, films.map((film, index) => [film.name + (index === films.length - 1 ? band : ""), seriesColour(index)]));
}

/** Moves the line that marks the frame. */
function markFrame(host, frame) {
  host.frame = frame;
  host.plot?.redraw(false, false);
}

/** Places of ticks on a logarithmic axis: 1, 2, 5 of every decade, or only its 1s, or all digits where it is short. */
function logSplits(_, __, low, high) {
  const decades = Math.log10(high / low), digits = decades > 3 ? [1] : decades > 0.7 ? [1, 2, 5] : [1, 2, 3, 4, 5, 6, 7, 8, 9];
  const splits = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power)
    for (const digit of digits) splits.push(digit * 10 ** power);
  return splits.filter((split) => split >= low && split <= high);
}

const logAxis = (label, size) => ({ ...axis(label, size), splits: logSplits, filter: (_, splits) => splits });
const logRange = (_, low, high) => (low > 0 ? [low / 1.25, high * 1.25] : [0.1, 1]);

/** Vertical bars from low to high at every point. */
function drawBars(plot, curves, clock) {
  const { ctx } = plot;
  ctx.save();
  ctx.lineWidth = 1.5 * devicePixelRatio;
  curves.forEach((curve, index) => {
    ctx.strokeStyle = seriesColour(index);
    ctx.beginPath();
    for (const point of curve.points.filter(({ low, high }) => low > 0 && high > low)) {
      const x = plot.valToPos(point[clock], "x", true), cap = 4 * devicePixelRatio;
      for (const end of [point.low, point.high]) {
        const y = plot.valToPos(end, "y", true);
        ctx.moveTo(x - cap, y);
        ctx.lineTo(x + cap, y);
      }
      ctx.moveTo(x, plot.valToPos(point.low, "y", true));
      ctx.lineTo(x, plot.valToPos(point.high, "y", true));
    }
    ctx.stroke();
  });
  ctx.restore();
}

/** Error against seconds, both logarithmic. Curves: {name, points: [{cpu, wall, error, low, high}]}. */
function drawCurves(host, { label, curves }, clock) {
  host.replaceChildren();
  const times = [...new Set(curves.flatMap((curve) => curve.points.map((point) => point[clock])))].sort((p, q) => p - q);
  const data = [times], series = [{}], extremes = [];
  curves.forEach((curve, index) => {
    const at = new Map(curve.points.map((point) => [point[clock], point.error]));
    data.push(times.map((time) => at.get(time) ?? null));
    for (const point of curve.points) extremes.push(point.low > 0 ? point.low : point.error, point.high || point.error);
    const colour = seriesColour(index);
    series.push({ label: curve.name, stroke: colour, width: 1.5, spanGaps: true, points: { show: true, size: 7, fill: colour } });
  });
  const range = [Math.min(...extremes), Math.max(...extremes)];
  const options = {
    width: plotWidth(host), height: 300, series, legend: { show: false },
    scales: { x: { time: false, distr: 3, range: logRange }, y: { distr: 3, range: () => logRange(null, ...range) } },
    axes: [logAxis(`${clock === "cpu" ? "CPU" : "wall"} seconds of the passes`, 46), logAxis(label, 66)],
    cursor: { drag: { x: false, y: false } }, hooks: { draw: [(plot) => drawBars(plot, curves, clock)] },
  };
  host.plot = new uPlot(options, data, host);
  key(host, curves.map((curve, index) => [curve.name, seriesColour(index)]));
}
