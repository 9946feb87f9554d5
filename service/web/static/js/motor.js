// @ts-check
/**
 * The page of a motor. Whoever looks closer at a trend of many records gets those of that time from the server;
 * and what somebody has opened or looks at closer stays so when the page follows a new record.
 */

import { charts, onChart } from "./charts/page.js";

const PAUSE_MS = 200;
const ID = "trend-data";
const PLACE = "trend-place";
const CHART = "trend-chart";

/** Parts that were open before they were written anew, by their ids. @type {Set<string>} */
const opened = new Set();

/** Get the records of a time when somebody looks closer at it. @param {import("./charts/chart.js").Chart} chart */
function follow(chart) {
  const place = document.getElementById(PLACE);
  if (!place) return;
  const whole = { x: chart.description.x, series: chart.description.series };
  let timer = 0;
  let asked = 0;
  chart.addEventListener("range", (event) => {
    const { from, to, whole: isWhole } = /** @type {CustomEvent} */ (event).detail;
    window.clearTimeout(timer);
    const number = ++asked;
    if (isWhole) {
      chart.update(whole);
      return;
    }
    timer = window.setTimeout(async () => {
      const address = `${place.dataset.trend}?from_s=${from.toFixed(3)}&to_s=${to.toFixed(3)}`;
      const answer = await fetch(address, { headers: { Accept: "application/json" } });
      if (!answer.ok || number !== asked) return;
      const piece = await answer.json();
      if (piece.x.values.length > 1) chart.update({ x: piece.x, series: piece.series });
    }, PAUSE_MS);
  });
}

/** Whether somebody looks at a part of the trend, or moves its cursor. */
function isLookedAt() {
  const chart = charts.get(ID);
  if (!chart) return false;
  const isWhole = chart.range[0] <= chart.whole[0] && chart.range[1] >= chart.whole[1];
  return !isWhole || chart.figure.contains(document.activeElement);
}

/** Whether somebody types into a part, so that it must not be written anew. @param {Element} part */
function isInUse(part) {
  const field = document.activeElement;
  return field !== null && part.contains(field) && field.matches("input, select, textarea");
}

/** @param {Event} event */
function keep(event) {
  const { detail } = /** @type {CustomEvent} */ (event);
  const part = /** @type {HTMLElement} */ (detail.target);
  if (isInUse(part) || (part.id === CHART && isLookedAt())) detail.shouldSwap = false;
  for (const one of part.querySelectorAll("details[open][id]")) opened.add(one.id);
}

document.addEventListener("htmx:beforeSwap", keep);
document.addEventListener("htmx:oobBeforeSwap", keep);
document.addEventListener("htmx:load", () => {
  for (const id of opened) document.getElementById(id)?.setAttribute("open", "");
  opened.clear();
});

// The trend is drawn when what is seen at once is painted, and anew when the page follows a record.
onChart((id, chart) => {
  if (id === ID) follow(chart);
});
