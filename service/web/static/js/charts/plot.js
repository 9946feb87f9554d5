// @ts-check
/** Draws a chart's description with uPlot: lines, bands, axes, and what lies over them. */

import { drawPoints, looksOf } from "./looks.js";
import { bands, limitsAndMarks } from "./overlays.js";
import { labelled, nameLines } from "./names.js";
import { colours } from "./theme.js";
import { inStepsOf, TIMES } from "./words.js";

/** @typedef {import("./description.js").Description} Description */
/** @typedef {import("./description.js").SeriesDescription} SeriesDescription */

const USUAL_WIDTH = 600; // CSS pixels
const NARROW = 480; // CSS pixels
const LONGEST_NAME = 10; // letters beside a row
const NAMES = 84; // CSS pixels beside the lines, for what they are called
const STATE_HEIGHT = 0.7; // of its row

/**
 * Draw into a place.
 * @param {HTMLElement} place
 * @param {Description} description
 * @param {object} state
 * @param {number} state.width of the place in CSS pixels; 0 before the page is laid out
 * @param {Set<string>} state.hidden labels of the series that are not shown
 * @param {() => number[]} state.markers lines that somebody has set
 * @param {(plot: any) => void} state.onSelect somebody has drawn over a part
 * @param {(plot: any) => void} state.onCursor somebody has moved the cursor
 * @returns {any} the plot of uPlot
 */
export function plotted(place, description, { width: known, hidden, markers, onSelect, onCursor }) {
  const theme = colours();
  const width = known || USUAL_WIDTH;
  const options = {
    width,
    height: description.height ?? 240,
    padding: [null, labelled(description) && width >= NARROW ? NAMES : null, null, null],
    legend: { show: false },
    scales: scales(description),
    axes: axes(description, theme, width < NARROW),
    cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { size: 6 } },
    ...lines(description, theme, hidden),
    hooks: {
      setSelect: [onSelect],
      setCursor: [onCursor],
      drawClear: [(/** @type {any} */ plot) => bands(plot, description, theme)],
      draw: [
        (/** @type {any} */ plot) => {
          nameLines(plot, description, hidden, theme, width >= NARROW ? NAMES : 0);
          drawPoints(plot, description.series, hidden, theme);
          limitsAndMarks(plot, description, markers(), theme);
        },
      ],
    },
  };
  // @ts-expect-error uPlot is a script of its own, not a module
  return new window.uPlot(options, columns(description), place);
}

/** Columns as uPlot takes them: x, then value, low and high of each series. @param {Description} description @returns {any[]} */
export function columns({ x, series, rows }) {
  const found = /** @type {any[]} */ ([x.values]);
  for (const [number, one] of series.entries()) {
    if (rows) {
      const base = series.length - 1 - number;
      found.push(Array.from(one.values, (value) => (value === null ? null : base + STATE_HEIGHT * value)));
      continue;
    }
    found.push(one.values);
    if (one.low && one.high) found.push(one.low, one.high);
  }
  return found;
}

/** @param {Description} description @param {import("./theme.js").Theme} theme @param {Set<string>} hidden */
function lines({ series }, theme, hidden) {
  const bands = [];
  const drawn = /** @type {any[]} */ ([{}]);
  const looks = looksOf(series);
  for (const [number, one] of series.entries()) {
    const show = !hidden.has(one.label);
    const { dash } = looks[number];
    drawn.push({ ...line(one, dash, theme), show });
    if (one.low && one.high) {
      if (show) bands.push({ series: [drawn.length + 1, drawn.length], fill: theme.faint(one.tone) });
      drawn.push({ ...edge(one, dash, theme), show }, { ...edge(one, dash, theme), show });
    }
  }
  return { series: drawn, bands };
}

/** @param {Description} description */
function scales(description) {
  return {
    x: { time: description.x.kind === "time", auto: false },
    y: { range: (/** @type {any} */ _plot, /** @type {number|null} */ low, /** @type {number|null} */ high) => reach(description, low, high) },
  };
}

/** From where to where the axis of y goes. @param {Description} description @param {number|null} low @param {number|null} high @returns {[number, number]} */
function reach({ y, limits, bands: grounds }, low, high) {
  const lines = [...(limits ?? []).map((one) => one.y), ...(grounds ?? []).flatMap((one) => [one.low, one.high])];
  const lowest = Math.min(low ?? Infinity, y.from ?? Infinity, ...lines);
  const highest = Math.max(high ?? -Infinity, y.to ?? -Infinity, ...lines);
  if (!(lowest <= highest)) return [0, 1];
  const room = 0.05 * (highest - lowest) || Math.abs(highest) * 0.05 || 1;
  return [y.from === lowest ? lowest : lowest - room, y.to === highest ? highest : highest + room];
}

/** @param {Description} description @param {import("./theme.js").Theme} theme @param {boolean} isNarrow */
function axes(description, theme, isNarrow) {
  const { x } = description;
  const inDigits = (/** @type {any} */ _plot, /** @type {number[]} */ splits, /** @type {number} */ _axis, /** @type {number} */ _space, /** @type {number} */ step) => inStepsOf(step, splits);
  const axis = { stroke: theme.of("muted"), grid: { stroke: theme.of("line"), width: 1 }, ticks: { show: false } };
  const ofNumbers = { values: inDigits, label: withUnit(x), labelSize: 18, size: 26 };
  return [
    { ...axis, ...(x.kind === "time" ? { values: TIMES } : ofNumbers) },
    { ...axis, values: inDigits, ...yAxis(description, isNarrow) },
  ];
}

/** @param {Description} description @param {boolean} isNarrow */
function yAxis({ y, series, rows }, isNarrow) {
  if (!rows) return { label: withUnit(y), labelSize: 20, size: isNarrow ? 46 : 60 };
  const places = series.map((_, number) => series.length - 1 - number + STATE_HEIGHT / 2);
  const names = series.map((one) => (one.label.length > LONGEST_NAME ? `${one.label.slice(0, LONGEST_NAME)}…` : one.label));
  return { splits: () => places, values: () => names, grid: { show: false }, size: 80 };
}

/** @param {{label: string, unit: string}} axis */
function withUnit({ label, unit }) {
  return unit ? `${label} (${unit})` : label;
}

/** @param {SeriesDescription} one @param {number[]} dash @param {import("./theme.js").Theme} theme */
function line(one, dash, theme) {
  // @ts-expect-error uPlot is a script of its own, not a module
  const paths = one.kind === "steps" ? window.uPlot.paths.stepped({ align: 1 }) : one.kind === "points" || one.kind === "envelope" ? () => null : undefined;
  return {
    label: one.label,
    stroke: theme.of(one.tone),
    width: one.kind === "dashes" || one.kind === "thin" ? 1 : 1.5,
    dash,
    paths,
    points: { show: one.kind === "points" || one.kind === "envelope" ? false : undefined, size: 5 },
  };
}

/** @param {SeriesDescription} one @param {number[]} dash @param {import("./theme.js").Theme} theme */
function edge(one, dash, theme) {
  const colour = one.kind === "envelope" ? theme.of(one.tone) : theme.faint(one.tone);
  return { stroke: colour, width: 1, dash: one.kind === "envelope" ? dash : [], points: { show: false } };
}
