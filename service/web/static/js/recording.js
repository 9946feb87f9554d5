// @ts-check
/**
 * The page of one recording: finer samples as one zooms in, the model's currents over the measured ones, phasors at
 * the cursor, two markers with what differs between them. All of it is asked of the service; nothing is worked out here.
 */

import { charts, drawCharts, onChart } from "./charts/page.js";
import { nearest } from "./charts/description.js";
import { formatY } from "./charts/words.js";
import { decoded } from "./charts/samples.js";

const PAUSE_MS = 120; // after the last movement, before the service is asked
const POINTS_A_PIXEL = 1;
const MOST_MODELLED = 8000; // values of a window over which the model's currents are drawn
const WAVEFORMS = /^(voltages|currents|others-\d+)-data$/;

const place = /** @type {HTMLElement} */ (document.querySelector("[data-recording]"));
const api = `/api/v1/recordings/${place.dataset.recording}`;
/** What the page came with, for the whole recording. @type {Map<string, any>} */
const whole = new Map();
/** @type {[number | null, number | null]} */
const markers = [null, null];
/** @type {AbortController | null} */
let asking = null;
let range = { from: 0, to: 0, whole: true };
let cursor = /** @type {number | null} */ (null);
let modelIsThere = false;
let markersTold = 0;

/** @param {(...values: any[]) => void} work */
function later(work) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let waiting;
  return (/** @type {any[]} */ ...values) => {
    clearTimeout(waiting);
    waiting = setTimeout(() => work(...values), PAUSE_MS);
  };
}

/** @param {string} what @param {Record<string, number>} query @param {AbortSignal} signal */
async function ask(what, query, signal) {
  const words = new URLSearchParams(Object.entries(query).map(([name, value]) => [name, String(value)]));
  const answer = await fetch(`${api}/${what}?${words}`, { signal });
  if (!answer.ok) throw new Error(`${what}: ${answer.status}`);
  return decoded(await answer.arrayBuffer());
}

const look = later(async () => {
  asking?.abort();
  asking = new AbortController();
  const { signal } = asking;
  try {
    if (range.whole) restore();
    else await showPart(signal);
    await showModel(signal);
    tellMarkers(); // finer values may be others
  } catch (error) {
    if (!(error instanceof DOMException && error.name === "AbortError")) throw error;
  }
});

function restore() {
  for (const [id, description] of whole) charts.get(id)?.update(description);
}

function points() {
  const width = Math.max(...[...charts.values()].map((chart) => chart.place.clientWidth), 300);
  return Math.min(Math.max(Math.round(width * POINTS_A_PIXEL), 200), 4000);
}

/** @param {AbortSignal} signal */
async function showPart(signal) {
  const part = await ask("samples", { from_s: range.from, to_s: range.to, points: points() }, signal);
  for (const [id, description] of whole) {
    if (!WAVEFORMS.test(id)) continue;
    const series = description.series.map((/** @type {any} */ one) => part.finer(one));
    charts.get(id)?.update({ x: { ...description.x, values: part.times }, series });
  }
}

/** The model's currents lie over single samples only: over extremes they would say nothing. @param {AbortSignal} signal */
async function showModel(signal) {
  const chart = charts.get("currents-data");
  const residual = charts.get("residual-data");
  if (!chart || !residual || !modelIsThere) return;
  if (range.whole) {
    residual.update(whole.get("residual-data"));
    return;
  }
  const model = await ask("model", { from_s: range.from, to_s: range.to, points: MOST_MODELLED }, signal);
  residual.update({
    x: { ...residual.description.x, values: model.times },
    series: whole.get("residual-data").series.map((/** @type {any} */ one) => model.column("residual", one)),
  });
  const measured = chart.description;
  const isOfSamples = measured.series.every((/** @type {any} */ one) => !one.low);
  const inRange = model.times.filter((time) => time >= range.from && time <= range.to).length > 1;
  if (!isOfSamples || model.isEnvelope || !inRange) return;
  const overlaid = ["a", "b", "c"].map((phase) => ({
    label: `model ${phase}`,
    unit: "A",
    tone: "model",
    kind: "thin",
    values: model.at("modelled", phase, measured.x.values),
  }));
  chart.update({ series: [...measured.series, ...overlaid] });
}

const showPhasors = later((/** @type {number} */ at) => {
  const field = /** @type {HTMLInputElement | null} */ (document.querySelector("[data-cursor-time]"));
  if (field) field.value = at.toFixed(4);
  // The target itself stays: a request that waits for the one before it has found its target already.
  // @ts-expect-error htmx is a script of its own
  window.htmx.ajax("GET", `${location.pathname}/phasors?at_s=${at}`, { target: "#phasors", swap: "innerHTML" });
});

/** @param {number} number */
function setMarker(number) {
  const chart = charts.get("currents-data") ?? charts.get("voltages-data");
  const at = cursor ?? (chart ? (chart.range[0] + chart.range[1]) / 2 : 0);
  markers[number] = at;
  tellMarkers();
}

function tellMarkers() {
  const set = markers.filter((one) => one !== null);
  if (set.length === 0 && markersTold === 0) return;
  markersTold = set.length;
  for (const [id, chart] of charts) if (WAVEFORMS.test(id) || id === "residual-data" || id === "states-data") chart.setMarkers(set);
  const into = /** @type {HTMLElement} */ (document.querySelector("[data-marker-table]"));
  const [first, second] = markers;
  if (first === null || second === null) {
    into.textContent = set.length === 0 ? "" : `Marker at ${formatY(set[0])} s. Set the other one to see what differs.`;
    return;
  }
  const apart = second - first;
  const rows = [["time (s)", first.toFixed(5), second.toFixed(5), apart.toFixed(5)]];
  if (apart !== 0) rows.push(["frequency of that period (Hz)", "", "", formatY(1 / Math.abs(apart))]);
  for (const [id, chart] of charts) {
    if (!WAVEFORMS.test(id)) continue;
    const { x, series } = chart.description;
    for (const one of series) {
      // Of an envelope no sample is known at the marker: one has to zoom in.
      const values = [first, second].map((at) => (one.kind === "envelope" ? null : one.values[nearest(x.values, at)]));
      const difference = values[0] == null || values[1] == null ? "–" : formatY(values[1] - values[0]);
      rows.push([`${one.label} (${one.unit})`, formatY(values[0]), formatY(values[1]), difference]);
    }
  }
  into.replaceChildren(table(["Between the markers", "Marker 1", "Marker 2", "Difference"], rows));
}

/** @param {string[]} headings @param {string[][]} rows */
function table(headings, rows) {
  const made = document.createElement("table");
  const cells = (/** @type {string[]} */ texts, /** @type {boolean} */ isHead) => {
    const row = document.createElement("tr");
    texts.forEach((text, column) => {
      const cell = document.createElement(isHead || column === 0 ? "th" : "td");
      if (isHead || column === 0) cell.scope = isHead ? "col" : "row";
      cell.className = column === 0 ? "" : "number";
      cell.textContent = text;
      row.append(cell);
    });
    return row;
  };
  const head = document.createElement("thead");
  head.append(cells(headings, true));
  const body = document.createElement("tbody");
  body.append(...rows.map((row) => cells(row, false)));
  made.append(head, body);
  const scroll = document.createElement("div");
  scroll.className = "scroll";
  scroll.tabIndex = 0;
  scroll.setAttribute("role", "group");
  scroll.setAttribute("aria-label", headings[0]);
  scroll.append(made);
  return scroll;
}

onChart((id, chart) => {
  if (!WAVEFORMS.test(id) && id !== "residual-data" && id !== "states-data") return;
  whole.set(id, chart.description);
  chart.addEventListener("range", (event) => {
    range = /** @type {CustomEvent} */ (event).detail;
    look();
  });
  chart.addEventListener("cursor", (event) => {
    cursor = /** @type {CustomEvent} */ (event).detail.x;
    showPhasors(cursor);
  });
  chart.place.addEventListener("keydown", ({ key }) => {
    if (key === "1" || key === "2") setMarker(Number(key) - 1);
  });
  if (id === "residual-data") {
    modelIsThere = true;
    look();
  }
});

for (const button of document.querySelectorAll("[data-marker]")) {
  button.addEventListener("click", () => {
    const which = /** @type {HTMLElement} */ (button).dataset.marker;
    if (which === "none") {
      markers.fill(null);
      tellMarkers();
    } else setMarker(Number(which));
  });
}
drawCharts(document);
