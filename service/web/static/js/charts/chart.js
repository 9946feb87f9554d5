// @ts-check
/**
 * A chart of series over one axis, drawn by uPlot from a description (service/web/charts/chart.py).
 *
 * It has what every chart of these pages needs: a cursor that the arrow keys move, the values at the cursor in
 * words, buttons for zoom, colours of the theme, marks and limits. The table of values comes from the server.
 */

import { colours, onThemeChange } from "./theme.js";
import { limitsAndMarks } from "./overlays.js";
import { formatX, formatY, inStepsOf } from "./words.js";

/**
 * @typedef {object} SeriesDescription
 * @property {string} label
 * @property {string} unit
 * @property {string} tone name of a colour of the theme
 * @property {"line"|"steps"|"points"|"dashes"|"thin"|"envelope"} kind of an envelope only `low` and `high` are drawn
 * @property {ArrayLike<number|null>} values
 * @property {ArrayLike<number|null>} [low] lower end of each value's interval or envelope
 * @property {ArrayLike<number|null>} [high]
 *
 * @typedef {object} Description
 * @property {{label: string, unit: string, kind: "number"|"time", values: ArrayLike<number>, from?: number|null, to?: number|null}} x
 * @property {{label: string, unit: string, from?: number|null, to?: number|null}} y
 * @property {SeriesDescription[]} series
 * @property {{x: number, label: string, tone: string}[]} [marks]
 * @property {{y: number, label: string, tone: string}[]} [limits]
 * @property {string} [sync] charts with the same name share cursor and zoom
 * @property {number} [height] in CSS pixels
 * @property {boolean} [rows] series are states, 0 or 1, each in a row of its own
 */

const FAR = 10; // steps of the cursor with the shift key
const ZOOM = 2;
const NARROW = 480; // CSS pixels
const LONGEST_NAME = 10; // letters beside a row
const STATE_HEIGHT = 0.7; // of its row
/** Dashes tell the phases apart where colours do not. @type {Record<string, number[]>} */
const DASHES = { b: [8, 3], c: [2, 2] };

/** Charts by the name that they share cursor and zoom under. @type {Map<string, Set<Chart>>} */
const groups = new Map();

export class Chart extends EventTarget {
  /**
   * Draw into a figure made by the template charts/figure.html.
   * Events: "cursor" (detail: {index, x}), "range" (detail: {from, to, whole}).
   * @param {HTMLElement} figure
   * @param {Description} description
   */
  constructor(figure, description) {
    super();
    this.figure = figure;
    this.description = description;
    this.place = /** @type {HTMLElement} */ (figure.querySelector("[data-chart-place]"));
    this.readout = /** @type {HTMLElement} */ (figure.querySelector("[data-chart-readout]"));
    /** @type {number[]} */
    this.markers = [];
    this.index = /** @type {number|null} */ (null);
    this.at = /** @type {number|null} */ (null);
    /** Labels of the series that are not shown. @type {Set<string>} */
    this.hidden = new Set();
    this.own = extent(description.x);
    this.place.tabIndex = 0;
    this.place.addEventListener("keydown", (event) => this.#key(event));
    this.place.addEventListener("focus", () => {
      if (this.index === null) this.moveTo(this.#middle());
    });
    this.#join();
    this.range = /** @type {[number, number]} */ ([...(this.#others()[0]?.range ?? this.own)]);
    this.#buttons();
    this.#legend();
    this.#draw();
    onThemeChange(() => this.#draw());
    new ResizeObserver(() => this.#fit()).observe(this.place);
  }

  /** Show other values, such as finer ones of the range that is seen. @param {Partial<Description>} changed */
  update(changed) {
    const before = shape(this.description);
    this.description = { ...this.description, ...changed };
    if (this.at !== null) this.index = this.#indexOf(this.at);
    if (shape(this.description) !== before) {
      this.#legend();
      this.#draw();
    } else this.plot.setData(this.#data(), false);
    this.#setScale();
    this.#say();
  }

  /** From where to where there is something to see, in this chart or in those with it. @returns {[number, number]} */
  get whole() {
    const all = [this.own, ...this.#others().map((one) => one.own)];
    return [Math.min(...all.map(([first]) => first)), Math.max(...all.map(([, last]) => last))];
  }

  /** Show from one value of x to another. @param {number} from @param {number} to */
  show(from, to) {
    const [first, last] = this.whole;
    const width = Math.min(Math.max(to - from, 1e-9 * (last - first || 1)), last - first);
    const begin = Math.min(Math.max(from, first), last - width);
    this.#apply([begin, begin + width]);
    for (const other of this.#others()) other.#apply(this.range);
  }

  /** Move the cursor to the value that is nearest. @param {number} x */
  moveToX(x) {
    this.moveTo(nearest(this.description.x.values, x));
  }

  /** Move the cursor to a value by its number. @param {number} index */
  moveTo(index) {
    const values = this.description.x.values;
    if (values.length === 0) return;
    const at = Math.min(Math.max(index, 0), values.length - 1);
    const x = values[at];
    if (x < this.range[0] || x > this.range[1]) {
      const width = this.range[1] - this.range[0];
      this.show(x - width / 2, x + width / 2);
    }
    this.#place(at, x);
    for (const other of this.#others()) other.#follow(x);
  }

  /** Put the cursor where that of another chart is, between values of this one perhaps. @param {number} x */
  #follow(x) {
    this.at = x;
    this.index = this.#indexOf(x);
    this.#pointAt();
    this.#say();
  }

  /** A state lasts until it changes; other values stand for what is around them. @param {number} x */
  #indexOf(x) {
    const { values } = this.description.x;
    const index = nearest(values, x);
    return this.description.rows && index > 0 && values[index] > x ? index - 1 : index;
  }

  /** Lines that somebody has set, at most two. @param {number[]} xs */
  setMarkers(xs) {
    this.markers = xs;
    this.plot.redraw(false);
    for (const other of this.#others()) {
      other.markers = xs;
      other.plot.redraw(false);
    }
  }

  #others() {
    const group = this.description.sync ? groups.get(this.description.sync) : undefined;
    return group ? [...group].filter((one) => one !== this && one.figure.isConnected) : [];
  }

  #join() {
    const name = this.description.sync;
    if (!name) return;
    if (!groups.has(name)) groups.set(name, new Set());
    /** @type {Set<Chart>} */ (groups.get(name)).add(this);
  }

  #middle() {
    return nearest(this.description.x.values, (this.range[0] + this.range[1]) / 2);
  }

  /** @param {[number, number]} range */
  #apply(range) {
    this.range = /** @type {[number, number]} */ ([...range]);
    this.#setScale();
    const whole = range[0] <= this.whole[0] && range[1] >= this.whole[1];
    this.dispatchEvent(new CustomEvent("range", { detail: { from: range[0], to: range[1], whole } }));
  }

  #setScale() {
    const [min, max] = this.range;
    this.plot.batch(() => this.plot.setScale("x", { min, max })); // at once: positions depend on it
    this.#pointAt();
  }

  /** @param {number} index @param {number} x */
  #place(index, x) {
    this.index = index;
    this.at = x;
    this.#pointAt();
    this.#say();
    this.dispatchEvent(new CustomEvent("cursor", { detail: { index, x } }));
  }

  /** Put the cursor's line where the cursor is. */
  #pointAt() {
    if (this.at === null) return;
    const left = this.plot.valToPos(this.at, "x");
    this.plot.setCursor({ left, top: this.plot.over.clientHeight / 2 }, false);
  }

  #say() {
    const { x, series } = this.description;
    if (this.index === null || this.index >= x.values.length) return;
    const at = this.index;
    const instant = this.at ?? x.values[at];
    const parts = series.filter((one) => !this.hidden.has(one.label)).map((one) => `${one.label} ${inWords(one, at)}`);
    this.readout.textContent = [`${x.label} ${formatX(this.description.rows ? instant : x.values[at], x)}`, ...parts].join(" · ");
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const at = this.index ?? this.#middle();
    const width = this.range[1] - this.range[0];
    const step = event.shiftKey ? FAR : 1;
    const x = this.description.x.values[at];
    /** @type {Record<string, () => void>} */
    const actions = {
      ArrowLeft: () => this.moveTo(at - step),
      ArrowRight: () => this.moveTo(at + step),
      PageUp: () => this.show(this.range[0] - width, this.range[1] - width),
      PageDown: () => this.show(this.range[0] + width, this.range[1] + width),
      Home: () => this.moveTo(nearest(this.description.x.values, this.range[0])),
      End: () => this.moveTo(nearest(this.description.x.values, this.range[1])),
      "+": () => this.#zoom(1 / ZOOM, x),
      "=": () => this.#zoom(1 / ZOOM, x),
      "-": () => this.#zoom(ZOOM, x),
      0: () => this.show(...this.whole),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  /** @param {number} factor @param {number} [around] */
  #zoom(factor, around) {
    const [from, to] = this.range;
    const centre = around !== undefined && around >= from && around <= to ? around : (from + to) / 2;
    this.show(centre - (centre - from) * factor, centre + (to - centre) * factor);
  }

  #buttons() {
    const row = this.figure.querySelector("[data-chart-tools]");
    if (!row) return;
    const part = () => (this.range[1] - this.range[0]) / 2;
    const x = () => (this.index === null ? undefined : this.description.x.values[this.index]);
    /** @type {[string, string, () => void][]} */
    const tools = [
      ["←", "Earlier", () => this.show(this.range[0] - part(), this.range[1] - part())],
      ["→", "Later", () => this.show(this.range[0] + part(), this.range[1] + part())],
      ["+", "Closer", () => this.#zoom(1 / ZOOM, x())],
      ["−", "Wider", () => this.#zoom(ZOOM, x())],
      ["↔", "Whole", () => this.show(...this.whole)],
    ];
    row.replaceChildren(
      ...tools.map(([sign, words, action]) => {
        const button = document.createElement("button");
        button.type = "button";
        button.textContent = sign;
        button.title = words;
        button.setAttribute("aria-label", `${words}: ${this.figure.dataset.chartName ?? "chart"}`);
        button.addEventListener("click", action);
        return button;
      }),
    );
  }

  /** Buttons that show and hide the series, each with a sample of its line. */
  #legend() {
    const row = this.figure.querySelector("[data-chart-legend]");
    if (!row) return;
    row.replaceChildren(
      ...this.description.series.map((one) => {
        const button = document.createElement("button");
        button.type = "button";
        button.className = `tone-${one.tone} kind-${one.kind}`;
        button.textContent = one.label;
        button.setAttribute("aria-pressed", String(!this.hidden.has(one.label)));
        button.addEventListener("click", () => {
          if (!this.hidden.delete(one.label)) this.hidden.add(one.label);
          button.setAttribute("aria-pressed", String(!this.hidden.has(one.label)));
          this.#draw();
        });
        return button;
      }),
    );
  }

  #fit() {
    const width = this.place.clientWidth;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: this.plot.height });
  }

  /** @returns {any[]} columns as uPlot takes them: x, then value, low and high of each series */
  #data() {
    const { x, series } = this.description;
    const columns = /** @type {any[]} */ ([x.values]);
    for (const [number, one] of series.entries()) {
      if (this.description.rows) {
        const base = series.length - 1 - number;
        columns.push(Array.from(one.values, (value) => (value === null ? null : base + STATE_HEIGHT * value)));
        continue;
      }
      columns.push(one.values);
      if (one.low && one.high) columns.push(one.low, one.high);
    }
    return columns;
  }

  #draw() {
    const theme = colours();
    const { x, y, series, height } = this.description;
    const bands = [];
    const lines = /** @type {any[]} */ ([{}]);
    for (const one of series) {
      const show = !this.hidden.has(one.label);
      lines.push({ ...line(one, theme), show });
      if (one.low && one.high) {
        if (show) bands.push({ series: [lines.length + 1, lines.length], fill: theme.faint(one.tone) });
        lines.push({ ...edge(one, theme), show }, { ...edge(one, theme), show });
      }
    }
    const inDigits = (/** @type {any} */ _plot, /** @type {number[]} */ splits, /** @type {number} */ _axis, /** @type {number} */ _space, /** @type {number} */ step) => inStepsOf(step, splits);
    const axis = { stroke: theme.of("muted"), grid: { stroke: theme.of("line"), width: 1 }, ticks: { show: false } };
    const options = {
      width: this.place.clientWidth || 600,
      height: height ?? 240,
      legend: { show: false },
      scales: { x: { time: x.kind === "time", auto: false }, y: { range: (/** @type {any} */ _plot, /** @type {number|null} */ low, /** @type {number|null} */ high) => this.#limits(low, high) } },
      axes: [
        { ...axis, ...(x.kind === "time" ? {} : { values: inDigits, label: `${x.label}${x.unit ? ` (${x.unit})` : ""}`, labelSize: 18, size: 26 }) },
        { ...axis, values: inDigits, ...this.#yAxis() },
      ],
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { size: 6 } },
      series: lines,
      bands,
      hooks: {
        setSelect: [(/** @type {any} */ plot) => this.#selected(plot)],
        setCursor: [(/** @type {any} */ plot) => this.#pointed(plot)],
        draw: [(/** @type {any} */ plot) => limitsAndMarks(plot, this.description, this.markers, theme)],
      },
    };
    this.plot?.destroy();
    // @ts-expect-error uPlot is a script of its own, not a module
    this.plot = new window.uPlot(options, this.#data(), this.place);
    this.#setScale();
  }

  #yAxis() {
    const { y, series, rows } = this.description;
    const narrow = (this.place.clientWidth || 600) < NARROW;
    if (!rows) return { label: y.unit ? `${y.label} (${y.unit})` : y.label, labelSize: 20, size: narrow ? 46 : 60 };
    const places = series.map((_, number) => series.length - 1 - number + STATE_HEIGHT / 2);
    const names = series.map((one) => (one.label.length > LONGEST_NAME ? `${one.label.slice(0, LONGEST_NAME)}…` : one.label));
    return { splits: () => places, values: () => names, grid: { show: false }, size: 80 };
  }

  /** @param {number|null} low @param {number|null} high @returns {[number, number]} */
  #limits(low, high) {
    const { y, limits } = this.description;
    const lines = (limits ?? []).map((one) => one.y);
    const lowest = Math.min(low ?? Infinity, y.from ?? Infinity, ...lines);
    const highest = Math.max(high ?? -Infinity, y.to ?? -Infinity, ...lines);
    if (!(lowest <= highest)) return [0, 1];
    const room = 0.05 * (highest - lowest) || Math.abs(highest) * 0.05 || 1;
    return [y.from === lowest ? lowest : lowest - room, y.to === highest ? highest : highest + room];
  }

  /** @param {any} plot */
  #selected(plot) {
    if (plot.select.width < 4) return;
    const from = plot.posToVal(plot.select.left, "x");
    const to = plot.posToVal(plot.select.left + plot.select.width, "x");
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.show(from, to);
  }

  /** @param {any} plot */
  #pointed(plot) {
    // Without an event it follows from a change of the scale, in which the cursor stays where it was.
    if (!plot.cursor.event || plot.cursor.idx === null || plot.cursor.idx === undefined) return;
    if (plot.cursor.idx === this.index) return;
    const x = this.description.x.values[plot.cursor.idx];
    this.#place(plot.cursor.idx, x);
    for (const other of this.#others()) other.#follow(x);
  }
}

/** What a plot has to be made anew for. @param {Description} description */
function shape(description) {
  const series = description.series.map((one) => [one.label, one.kind, one.tone, Boolean(one.low && one.high)]);
  return JSON.stringify([series, description.marks, description.limits]);
}

/** What the axis reaches over: all values, and what it has to include. @param {Description["x"]} x @returns {[number, number]} */
function extent({ values, from, to }) {
  const [first, last] = values.length === 0 ? [from ?? 0, to ?? 1] : [values[0], values[values.length - 1]];
  return [Math.min(first, from ?? first), Math.max(last, to ?? last)];
}

/** Number of the nearest of ascending values. @param {ArrayLike<number>} values @param {number} x */
export function nearest(values, x) {
  let low = 0;
  let high = values.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] < x) low = middle;
    else high = middle;
  }
  return high > low && x - values[low] > values[high] - x ? high : Math.max(low, 0);
}

/** @param {SeriesDescription} one @param {number} at */
function inWords(one, at) {
  const value = one.values[at];
  const low = one.low?.[at];
  const high = one.high?.[at];
  const missing = value === null || value === undefined || Number.isNaN(value);
  const spread = low !== null && low !== undefined && high !== null && high !== undefined && low !== high;
  if (missing && !spread) return "–";
  const unit = one.unit ? ` ${one.unit}` : "";
  if (missing || (one.kind === "envelope" && spread)) return `${formatY(low)} to ${formatY(high)}${unit}`;
  return `${formatY(value)}${spread ? ` (${formatY(low)} to ${formatY(high)})` : ""}${unit}`;
}

/** @param {SeriesDescription} one @param {import("./theme.js").Theme} theme */
function line(one, theme) {
  // @ts-expect-error uPlot is a script of its own, not a module
  const paths = one.kind === "steps" ? window.uPlot.paths.stepped({ align: 1 }) : one.kind === "points" || one.kind === "envelope" ? () => null : undefined;
  return {
    label: one.label,
    stroke: theme.of(one.tone),
    width: one.kind === "dashes" || one.kind === "thin" ? 1 : 1.5,
    dash: one.kind === "dashes" ? [2, 3] : DASHES[one.tone],
    paths,
    points: { show: one.kind === "points" ? true : one.kind === "envelope" ? false : undefined, size: 5 },
  };
}

/** @param {SeriesDescription} one @param {import("./theme.js").Theme} theme */
function edge(one, theme) {
  const colour = one.kind === "envelope" ? theme.of(one.tone) : theme.faint(one.tone);
  return { stroke: colour, width: 1, points: { show: false } };
}
