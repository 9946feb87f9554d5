// @ts-check
/** Draws every chart of a page whose description is in the page: <figure data-chart="id of the JSON">. */

import { Chart } from "./chart.js";
import { offerPictures } from "./saving.js";

/** Charts of the page by the id of their description. @type {Map<string, Chart>} */
export const charts = new Map();
/** @type {Set<(id: string, chart: Chart) => void>} */
const listeners = new Set();

/** Call a function with each chart of the page, those that come later too. @param {(id: string, chart: Chart) => void} listener */
export function onChart(listener) {
  listeners.add(listener);
  for (const [id, chart] of charts) listener(id, chart);
}

/** Draw what is not drawn yet: what is seen at once, what lies further down one by one. @param {ParentNode} within */
export function drawCharts(within) {
  const figures = [.../** @type {NodeListOf<HTMLElement>} */ (within.querySelectorAll("figure[data-chart]"))].filter(isDue);
  const isSeen = figures.map((figure) => figure.getBoundingClientRect().top < innerHeight); // before the first one is drawn
  figures.filter((_, number) => isSeen[number]).forEach(draw);
  drawAfterwards(figures.filter((_, number) => !isSeen[number]));
}

/** Draw one after the other, each once what is there already is painted. @param {HTMLElement[]} figures */
function drawAfterwards([figure, ...others]) {
  if (figure === undefined) return;
  afterPainting(() => {
    if (isDue(figure)) draw(figure);
    drawAfterwards(others);
  });
}

/** @param {() => void} work */
function afterPainting(work) {
  requestAnimationFrame(() => setTimeout(work));
}

/** @param {HTMLElement} figure */
function isDue(figure) {
  const id = figure.dataset.chart ?? "";
  return figure.isConnected && charts.get(id)?.figure !== figure && Boolean(document.getElementById(id)?.textContent);
}

/** @param {HTMLElement} figure */
function draw(figure) {
  const id = figure.dataset.chart ?? "";
  const chart = new Chart(figure, JSON.parse(document.getElementById(id)?.textContent ?? ""));
  charts.set(id, chart);
  for (const listener of listeners) listener(id, chart);
}

performance.mark("charts: data");
afterPainting(() => performance.measure("charts: first paint", "charts: data")); // of those that are seen at once
drawCharts(document);
offerPictures(document);
// Parts that htmx has put into the page anew.
document.addEventListener("htmx:load", (event) => {
  const part = event.target;
  if (!(part instanceof HTMLElement)) return;
  drawCharts(part.parentElement ?? part);
  offerPictures(part.parentElement ?? part);
});
