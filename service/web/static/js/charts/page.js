// @ts-check
/** Draws every chart of a page whose description is in the page: <figure data-chart="id of the JSON">. */

import { Chart } from "./chart.js";

/** Charts of the page by the id of their description. @type {Map<string, Chart>} */
export const charts = new Map();
/** @type {Set<(id: string, chart: Chart) => void>} */
const listeners = new Set();

/** Call a function with each chart of the page, those that come later too. @param {(id: string, chart: Chart) => void} listener */
export function onChart(listener) {
  listeners.add(listener);
  for (const [id, chart] of charts) listener(id, chart);
}

/** @param {ParentNode} within */
export function drawCharts(within) {
  for (const figure of /** @type {NodeListOf<HTMLElement>} */ (within.querySelectorAll("figure[data-chart]"))) {
    const id = figure.dataset.chart ?? "";
    const source = document.getElementById(id);
    if (!source?.textContent || charts.get(id)?.figure === figure) continue;
    if (figure.dataset.chartLater !== undefined) {
      delete figure.dataset.chartLater;
      setTimeout(() => drawCharts(figure.parentElement ?? within));
      continue;
    }
    const chart = new Chart(figure, JSON.parse(source.textContent));
    charts.set(id, chart);
    for (const listener of listeners) listener(id, chart);
  }
}

performance.mark("charts: data");
drawCharts(document);
// The lines are on the canvas at the end of the frame that follows.
requestAnimationFrame(() => setTimeout(() => performance.measure("charts: first paint", "charts: data")));
// Parts that htmx has put into the page anew.
document.addEventListener("htmx:load", (event) => {
  const part = event.target;
  if (part instanceof HTMLElement) drawCharts(part.parentElement ?? part);
});
