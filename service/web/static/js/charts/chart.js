// @ts-check
/**
 * A chart of series over one axis: what of it is seen, where its cursor is, and the charts that follow both.
 *
 * The values at the cursor are told in words. The table of values comes from the server.
 */

import { addLegend, addTools, pressed } from "./controls.js";
import { extent, nearest, shape } from "./description.js";
import { columns, plotted } from "./plot.js";
import { onThemeChange } from "./theme.js";
import { formatX, inWords } from "./words.js";

/** @typedef {import("./description.js").Description} Description */

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
    this.place.addEventListener("keydown", (event) => pressed(this, event));
    this.place.addEventListener("focus", () => {
      if (this.index === null) this.moveTo(this.middle);
    });
    this.#join();
    this.range = /** @type {[number, number]} */ ([...(this.#others()[0]?.range ?? this.own)]);
    addTools(this);
    addLegend(this);
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
      addLegend(this);
      this.#draw();
    } else this.plot.setData(columns(this.description), false);
    this.#setScale();
    this.#say();
  }

  /** From where to where there is something to see, in this chart or in those with it. @returns {[number, number]} */
  get whole() {
    const all = [this.own, ...this.#others().map((one) => one.own)];
    return [Math.min(...all.map(([first]) => first)), Math.max(...all.map(([, last]) => last))];
  }

  /** Number of the value in the middle of what is seen. */
  get middle() {
    return nearest(this.description.x.values, (this.range[0] + this.range[1]) / 2);
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

  /** Show or hide a series. @param {string} label */
  toggle(label) {
    if (!this.hidden.delete(label)) this.hidden.add(label);
    this.#draw();
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

  #fit() {
    const width = this.place.clientWidth;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: this.plot.height });
  }

  #draw() {
    const width = this.place.clientWidth; // before the place is empty: the page would be laid out without the chart
    this.plot?.destroy();
    this.plot = plotted(this.place, this.description, {
      width,
      hidden: this.hidden,
      markers: () => this.markers,
      onSelect: (plot) => this.#selected(plot),
      onCursor: (plot) => this.#pointed(plot),
    });
    this.#setScale();
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
