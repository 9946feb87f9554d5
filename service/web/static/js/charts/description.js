// @ts-check
/** What a chart is drawn from (service/web/charts/chart.py), and where its values are. */

/**
 * @typedef {object} SeriesDescription
 * @property {string} label
 * @property {string} [short] what stands at the end of its line
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
 * @property {{low: number, high: number, label: string, tone: string}[]} [bands] grounds between values of y
 * @property {string} [sync] charts with the same name share cursor and zoom
 * @property {number} [height] in CSS pixels
 * @property {boolean} [rows] series are states, 0 or 1, each in a row of its own
 */

/** What a plot has to be made anew for. @param {Description} description */
export function shape(description) {
  const series = description.series.map((one) => [one.label, one.kind, one.tone, Boolean(one.low && one.high)]);
  return JSON.stringify([series, description.y, description.marks, description.limits, description.bands]);
}

/** What the axis reaches over: all values, and what it has to include. @param {Description["x"]} x @returns {[number, number]} */
export function extent({ values, from, to }) {
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
