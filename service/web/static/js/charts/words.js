// @ts-check
/** Numbers and times of charts as people read them. */

import { clock } from "../clock.js";

const DIGITS = 4;

const DAY = "\n{YYYY}-{MM}-{DD}";
const MINUTE = `${DAY} {HH}:{mm}`;
/** What is written at the marks of an axis of time, from which step [s] on: then with a new year, month, day, hour, minute. */
export const TIMES = [
  [31_536_000, "{YYYY}", null, null, null, null, null, null, 1],
  [2_419_200, "{YYYY}-{MM}", null, null, null, null, null, null, 1],
  [86_400, "{MM}-{DD}", "\n{YYYY}", null, null, null, null, null, 1],
  [60, "{HH}:{mm}", DAY, null, DAY, null, null, null, 1],
  [1, "{HH}:{mm}:{ss}", DAY, null, DAY, null, null, null, 1],
  [0.001, ":{ss}.{fff}", MINUTE, null, MINUTE, null, MINUTE, null, 1],
];

/** @param {number|null|undefined} value */
export function formatY(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e6)) return value.toExponential(DIGITS - 1);
  return String(Number(value.toPrecision(DIGITS)));
}

/** A value of a series, with its interval. @param {import("./description.js").SeriesDescription} one @param {number} at its number */
export function inWords(one, at) {
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

/** @param {number} value @param {{kind: string, unit: string}} axis */
export function formatX(value, axis) {
  if (axis.kind === "time") return clock(new Date(value * 1000), true);
  return `${String(Number(value.toPrecision(7)))}${axis.unit ? ` ${axis.unit}` : ""}`;
}

const MOST_DECIMALS = 12;

/** Numbers of an axis, with as many decimals as the step from one to the next has. @param {number} step @param {number[]} values */
export function inStepsOf(step, values) {
  let decimals = 0;
  while (decimals < MOST_DECIMALS && Math.abs(step - Number(step.toFixed(decimals))) > 1e-6 * step) decimals += 1;
  return values.map((value) => (Number(value.toFixed(decimals)) + 0).toFixed(decimals));
}
