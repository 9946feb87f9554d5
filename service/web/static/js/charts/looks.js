// @ts-check
/** How series are told apart without their colours: lines by dashes, points by shapes, in charts and legends alike. */

/** @typedef {import("./description.js").SeriesDescription} SeriesDescription */

/** Of lines in their order; phases a, b and c have the first three. @type {number[][]} */
const DASHES = [[], [8, 3], [2, 2], [8, 3, 2, 3], [14, 4], [5, 5]];
/** @type {Record<string, number>} */
const PHASES = { a: 0, b: 1, c: 2 };
/** Of points in their order. */
const SHAPES = ["circle", "diamond", "cross", "plus", "ring"];
/** Of points that tell a state, as in the pictures. @type {Record<string, string>} */
const STATES = { watch: "triangle", fault: "square" };
const RADIUS = 3.5; // CSS pixels

/** @typedef {{dash: number[], shape: string | null}} Look */

/** The look of each series of a chart. @param {SeriesDescription[]} series @returns {Look[]} */
export function looksOf(series) {
  /** @type {Record<string, number>} */
  const seen = {};
  return series.map((one) => {
    if (one.kind === "points") {
      const state = STATES[one.tone];
      if (state) return { dash: [], shape: state };
      seen.points = (seen.points ?? -1) + 1;
      return { dash: [], shape: SHAPES[seen.points % SHAPES.length] };
    }
    if (one.tone in PHASES) return { dash: DASHES[PHASES[one.tone]], shape: null };
    if (one.kind === "dashes") return { dash: [2, 3], shape: null };
    if (one.kind === "steps" || !hasLine(one)) return { dash: [], shape: null };
    seen[one.kind] = (seen[one.kind] ?? -1) + 1;
    return { dash: DASHES[seen[one.kind] % DASHES.length], shape: null };
  });
}

/** Whether a series has a line, and not a band alone. @param {SeriesDescription} one */
function hasLine({ kind, values }) {
  return kind === "envelope" || Array.prototype.some.call(values, (value) => value !== null);
}

/**
 * Draw the points of a plot, each in its shape.
 * @param {any} plot
 * @param {SeriesDescription[]} series
 * @param {Set<string>} hidden
 * @param {import("./theme.js").Theme} theme
 */
export function drawPoints(plot, series, hidden, theme) {
  const { ctx, bbox } = plot;
  const ratio = plot.pxRatio ?? window.devicePixelRatio;
  const xs = plot.data[0];
  const looks = looksOf(series);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left - RADIUS * ratio, bbox.top - RADIUS * ratio, bbox.width + 2 * RADIUS * ratio, bbox.height + 2 * RADIUS * ratio);
  ctx.clip();
  ctx.setLineDash([]);
  ctx.lineWidth = 1.5 * ratio;
  for (const [number, one] of series.entries()) {
    const { shape } = looks[number];
    if (shape === null || hidden.has(one.label)) continue;
    ctx.strokeStyle = theme.of(one.tone);
    ctx.fillStyle = theme.of(shape === "circle" ? one.tone : "surface");
    for (let at = 0; at < xs.length; at += 1) {
      const value = one.values[at];
      if (value === null || xs[at] < plot.scales.x.min || xs[at] > plot.scales.x.max) continue;
      const path = new Path2D(outline(shape, plot.valToPos(xs[at], "x", true), plot.valToPos(value, "y", true), RADIUS * ratio));
      if (shape !== "cross" && shape !== "plus") ctx.fill(path);
      ctx.stroke(path);
    }
  }
  ctx.restore();
}

/** A shape around a place, as the path of an SVG. @param {string} shape @param {number} x @param {number} y @param {number} r */
export function outline(shape, x, y, r) {
  switch (shape) {
    case "triangle":
      return `M${x} ${y - 1.2 * r}L${x + 1.1 * r} ${y + 0.8 * r}H${x - 1.1 * r}Z`;
    case "square":
      return `M${x - r} ${y - r}H${x + r}V${y + r}H${x - r}Z`;
    case "diamond":
      return `M${x} ${y - 1.2 * r}L${x + 1.2 * r} ${y}L${x} ${y + 1.2 * r}L${x - 1.2 * r} ${y}Z`;
    case "cross":
      return `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`;
    case "plus":
      return `M${x - r} ${y}H${x + r}M${x} ${y - r}V${y + r}`;
    default:
      return `M${x - r} ${y}A${r} ${r} 0 1 0 ${x + r} ${y}A${r} ${r} 0 1 0 ${x - r} ${y}Z`;
  }
}

const SAMPLE = { width: 28, height: 10 };

/** A sample of a series for the legend: its line, its shape, or the ground of its band. @param {SeriesDescription} one @param {Look} look */
export function sampleOf(one, { dash, shape }) {
  const { width, height } = SAMPLE;
  const sample = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" });
  if (shape !== null) {
    sample.append(svg("path", { d: outline(shape, width / 2, height / 2, RADIUS), class: shape === "circle" ? "filled" : "hollow" }));
  } else if (!hasLine(one)) {
    sample.append(svg("rect", { width, height, class: "band" }));
  } else {
    const thick = one.kind === "thin" || one.kind === "dashes" ? 1 : 2;
    sample.append(svg("line", { x1: 0, x2: width, y1: height / 2, y2: height / 2, "stroke-width": thick, "stroke-dasharray": dash.join(" ") }));
  }
  return sample;
}

/** @param {string} name @param {Record<string, string|number>} attributes */
function svg(name, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return element;
}
