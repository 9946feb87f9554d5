// @ts-check
/** Charts and pictures as files: their values as CSV, and what is seen as a picture. */

import { colours } from "./theme.js";

/** @typedef {import("./chart.js").Chart} Chart */

const MARGIN = 12; // CSS pixels
const LINE = 18;
const CAPTION = 14;
const SMALL = 12;

/** Buttons that fetch the values and the picture of a chart. @param {Chart} chart @returns {HTMLButtonElement[]} */
export function savingTools(chart) {
  const { figure } = chart;
  return [
    tool("CSV", figure, () => save(textBlob(csvOf(chart)), `${nameOf(figure)}.csv`)),
    tool("PNG", figure, () => drawing(chart).toBlob((blob) => blob && save(blob, `${nameOf(figure)}.png`))),
  ];
}

/** The same for pictures that came as SVG, with the values in the table behind them. @param {ParentNode} within */
export function offerPictures(within) {
  for (const figure of /** @type {NodeListOf<HTMLElement>} */ (within.querySelectorAll("figure[data-picture]"))) {
    const row = figure.querySelector("[data-chart-tools]");
    const picture = figure.querySelector("svg");
    const table = figure.querySelector("table");
    if (!row || !picture || row.childElementCount > 0) continue;
    const tools = [tool("SVG", figure, () => save(new Blob([svgText(picture)], { type: "image/svg+xml" }), `${nameOf(figure)}.svg`))];
    if (table) tools.unshift(tool("CSV", figure, () => save(textBlob(csvOfTable(table)), `${nameOf(figure)}.csv`)));
    row.replaceChildren(...tools);
  }
}

/** @param {string} words @param {HTMLElement} figure @param {() => void} action */
function tool(words, figure, action) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = words;
  button.title = words === "CSV" ? "Values as CSV" : `Picture as ${words}`;
  button.setAttribute("aria-label", `${button.title}: ${captionOf(figure)}`);
  button.addEventListener("click", action);
  return button;
}

/** All values of a chart, times in UTC. @param {Chart} chart */
function csvOf({ description }) {
  const { x, series } = description;
  const withUnit = (/** @type {string} */ label, /** @type {string} */ unit) => (unit ? `${label} (${unit})` : label);
  const columns = series.flatMap((one) => [
    { head: withUnit(one.label, one.unit), values: one.values },
    ...(one.low && one.high ? [{ head: `${one.label}: low`, values: one.low }, { head: `${one.label}: high`, values: one.high }] : []),
  ]);
  const lines = [[x.kind === "time" ? "time (UTC)" : withUnit(x.label, x.unit), ...columns.map((one) => one.head)]];
  for (let at = 0; at < x.values.length; at += 1) {
    const first = x.kind === "time" ? new Date(x.values[at] * 1000).toISOString() : String(x.values[at]);
    lines.push([first, ...columns.map((one) => (one.values[at] === null ? "" : String(one.values[at])))]);
  }
  return asCsv(lines);
}

/** @param {HTMLTableElement} table */
function csvOfTable(table) {
  return asCsv([...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent ?? "")));
}

/** Lines of cells; what a spreadsheet would take for a formula gets an apostrophe. @param {string[][]} lines */
function asCsv(lines) {
  const cell = (/** @type {string} */ text) => {
    const safe = /^[=+@\t\r]|^-(?![\d.])/.test(text) ? `'${text}` : text;
    return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
  };
  return lines.map((line) => `${line.map(cell).join(",")}\r\n`).join("");
}

/** What is seen of a chart, with its caption and what it says. @param {Chart} chart */
function drawing(chart) {
  const plot = /** @type {HTMLCanvasElement} */ (chart.place.querySelector("canvas"));
  const theme = colours();
  const ratio = window.devicePixelRatio;
  const made = document.createElement("canvas");
  made.width = plot.width + 2 * MARGIN * ratio;
  made.height = plot.height + (2 * MARGIN + 2 * LINE) * ratio;
  const ctx = /** @type {CanvasRenderingContext2D} */ (made.getContext("2d"));
  ctx.fillStyle = theme.of("surface");
  ctx.fillRect(0, 0, made.width, made.height);
  const family = getComputedStyle(document.body).fontFamily;
  ctx.fillStyle = theme.of("ink");
  ctx.font = `600 ${CAPTION * ratio}px ${family}`;
  ctx.fillText(captionOf(chart.figure), MARGIN * ratio, (MARGIN + CAPTION) * ratio);
  ctx.drawImage(plot, MARGIN * ratio, (MARGIN + LINE) * ratio);
  ctx.fillStyle = theme.of("muted");
  ctx.font = `${SMALL * ratio}px ${family}`;
  const names = chart.description.series.filter((one) => !chart.hidden.has(one.label)).map((one) => one.label);
  ctx.fillText(names.join(" · "), MARGIN * ratio, made.height - MARGIN * ratio, made.width - 2 * MARGIN * ratio);
  return made;
}

/** A picture with the colours that the page's styles give it. @param {SVGElement} picture */
function svgText(picture) {
  const copy = /** @type {SVGElement} */ (picture.cloneNode(true));
  const parts = [picture, ...picture.querySelectorAll("*")];
  [copy, ...copy.querySelectorAll("*")].forEach((part, number) => {
    const seen = getComputedStyle(parts[number]);
    for (const name of ["fill", "stroke"]) {
      if (part.getAttribute(name)?.includes("var(")) part.setAttribute(name, seen.getPropertyValue(name));
    }
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  return new XMLSerializer().serializeToString(copy);
}

/** @param {HTMLElement} figure */
function captionOf(figure) {
  return figure.dataset.chartName ?? figure.querySelector("figcaption span")?.textContent?.trim() ?? "";
}

/** @param {HTMLElement} figure */
function nameOf(figure) {
  return captionOf(figure).replace(/[^\p{L}\p{N}._-]+/gu, "-");
}

/** @param {string} text */
function textBlob(text) {
  return new Blob(["\uFEFF", text], { type: "text/csv;charset=utf-8" });
}

/** @param {Blob} blob @param {string} name */
function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
