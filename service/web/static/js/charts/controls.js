// @ts-check
/** What people move a chart with: keys, buttons for zoom, and buttons that show and hide its series. */

import { nearest } from "./description.js";
import { looksOf, sampleOf } from "./looks.js";
import { savingTools } from "./saving.js";

/** @typedef {import("./chart.js").Chart} Chart */

const FAR = 10; // steps of the cursor with the shift key
const ZOOM = 2;

/** Do what a key stands for. @param {Chart} chart @param {KeyboardEvent} event */
export function pressed(chart, event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const values = chart.description.x.values;
  const [from, to] = chart.range;
  const width = to - from;
  const at = chart.index ?? chart.middle;
  const step = event.shiftKey ? FAR : 1;
  /** @type {Record<string, () => void>} */
  const actions = {
    ArrowLeft: () => chart.moveTo(at - step),
    ArrowRight: () => chart.moveTo(at + step),
    PageUp: () => chart.show(from - width, to - width),
    PageDown: () => chart.show(from + width, to + width),
    Home: () => chart.moveTo(nearest(values, from)),
    End: () => chart.moveTo(nearest(values, to)),
    "+": () => zoom(chart, 1 / ZOOM, values[at]),
    "=": () => zoom(chart, 1 / ZOOM, values[at]),
    "-": () => zoom(chart, ZOOM, values[at]),
    0: () => chart.show(...chart.whole),
  };
  const action = actions[event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

/** Put the buttons for zoom into the chart's figure. @param {Chart} chart */
export function addTools(chart) {
  const row = chart.figure.querySelector("[data-chart-tools]");
  if (!row) return;
  const half = () => (chart.range[1] - chart.range[0]) / 2;
  const x = () => (chart.index === null ? undefined : chart.description.x.values[chart.index]);
  /** @type {[string, string, () => void][]} */
  const tools = [
    ["←", "Earlier", () => chart.show(chart.range[0] - half(), chart.range[1] - half())],
    ["→", "Later", () => chart.show(chart.range[0] + half(), chart.range[1] + half())],
    ["+", "Closer", () => zoom(chart, 1 / ZOOM, x())],
    ["−", "Wider", () => zoom(chart, ZOOM, x())],
    ["↔", "Whole", () => chart.show(...chart.whole)],
  ];
  row.replaceChildren(
    ...tools.map(([sign, words, action]) => {
      const button = buttonOf(sign, action);
      button.title = words;
      button.setAttribute("aria-label", `${words}: ${chart.figure.dataset.chartName ?? "chart"}`);
      return button;
    }),
    ...savingTools(chart),
  );
}

/** Put buttons that show and hide the series into the figure, each with a sample of its line. @param {Chart} chart */
export function addLegend(chart) {
  const row = chart.figure.querySelector("[data-chart-legend]");
  if (!row) return;
  const { series } = chart.description;
  const looks = looksOf(series);
  row.replaceChildren(
    ...series.map((one, number) => {
      const button = buttonOf(one.label, () => {
        chart.toggle(one.label);
        button.setAttribute("aria-pressed", String(!chart.hidden.has(one.label)));
      });
      button.className = `tone-${one.tone}`;
      button.prepend(sampleOf(one, looks[number]));
      button.setAttribute("aria-pressed", String(!chart.hidden.has(one.label)));
      return button;
    }),
  );
}

/** @param {Chart} chart @param {number} factor @param {number} [around] */
function zoom(chart, factor, around) {
  const [from, to] = chart.range;
  const centre = around !== undefined && around >= from && around <= to ? around : (from + to) / 2;
  chart.show(centre - (centre - from) * factor, centre + (to - centre) * factor);
}

/** @param {string} text @param {() => void} action */
function buttonOf(text, action) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = text;
  button.addEventListener("click", action);
  return button;
}
