// What every page has: times in the viewer's zone, ages that go on, drafts, and words when the service is away.

import { clock, offset } from "./clock.js";

const MINUTE_MS = 60_000;

function ageInWords(ms) {
  const seconds = Math.abs(ms) / 1000;
  for (const [length, unit] of [[31557600, "year"], [86400, "day"], [3600, "hour"], [60, "minute"]]) {
    if (seconds >= 2 * length) return `${Math.floor(seconds / length)} ${unit}s`;
  }
  const whole = Math.floor(seconds);
  return whole === 1 ? "1 second" : `${whole} seconds`;
}

/** Write the times below an element in the viewer's zone; their titles have its offset, and UTC. */
export function localise(root) {
  for (const element of root.querySelectorAll("time[data-local]")) {
    const [date, hasSeconds] = [new Date(element.dateTime), element.dataset.local === "seconds"];
    element.textContent = clock(date, hasSeconds);
    element.title = `${clock(date, hasSeconds)} ${offset(date)} (${element.title})`;
    delete element.dataset.local;
  }
  for (const element of root.querySelectorAll("time[data-age]")) {
    const ms = Date.now() - Date.parse(element.dateTime);
    element.textContent = ms < -1000 ? `in ${ageInWords(ms)}` : `${ageInWords(ms)} ago`;
  }
}

// Words that somebody types stay in this tab until they were sent, whatever happens to the session meanwhile.
// They belong to who typed them: somebody else who logs in here does not see them.
const DRAFT = `statorwatch draft ${document.documentElement.dataset.user ?? ""} `;
const keyOf = (field) => DRAFT + field.dataset.draft;
const isBox = (field) => field.type === "checkbox";

function restoreDrafts(root) {
  for (const field of root.querySelectorAll("[data-draft]")) {
    const kept = sessionStorage.getItem(keyOf(field));
    if (kept === null) continue;
    if (isBox(field)) field.checked = true;
    else if (field.value === "") field.value = kept;
    else if (field instanceof HTMLSelectElement && [...field.options].some(({ value }) => value === kept)) field.value = kept;
  }
}

function forgetDrafts(form) {
  for (const field of form.querySelectorAll("[data-draft]")) sessionStorage.removeItem(keyOf(field));
}

document.addEventListener("input", ({ target }) => {
  if (target.dataset?.draft === undefined) return;
  const isEmpty = isBox(target) ? !target.checked : target.value === "";
  if (isEmpty) sessionStorage.removeItem(keyOf(target));
  else sessionStorage.setItem(keyOf(target), target.value);
});

// Who logs out leaves nothing behind in this tab. A session that ends by itself does.
document.addEventListener("submit", ({ target }) => {
  if (target.getAttribute("action") !== "/logout") return;
  for (const key of Object.keys(sessionStorage)) if (key.startsWith(DRAFT)) sessionStorage.removeItem(key);
});

// A form that was sent waits for its answer, and is not sent again meanwhile. Its button keeps the focus.
const LONGEST_WAIT_MS = 30_000; // an answer may be a file, after which the page stays

function endWaiting() {
  for (const button of document.querySelectorAll("button[aria-busy]")) {
    button.removeAttribute("aria-busy");
    button.removeAttribute("aria-disabled");
  }
  for (const form of document.querySelectorAll("form[data-sent]")) delete form.dataset.sent;
}

document.addEventListener("submit", (event) => {
  if (event.target.dataset.sent === undefined) return;
  event.preventDefault();
  event.stopImmediatePropagation();
}, { capture: true });
document.addEventListener("submit", (event) => {
  const { target, submitter } = event;
  const isOfHtmx = target.closest("[hx-boost], [hx-post]") !== null;
  if (target.method !== "post" || (event.defaultPrevented && !isOfHtmx)) return;
  target.dataset.sent = "";
  submitter?.setAttribute("aria-busy", "true");
  submitter?.setAttribute("aria-disabled", "true");
  setTimeout(endWaiting, LONGEST_WAIT_MS);
});
window.addEventListener("pageshow", endWaiting);
document.addEventListener("htmx:afterRequest", ({ detail }) => {
  if (detail.requestConfig.verb !== "get") endWaiting();
});

// Times are typed in the viewer's zone, as all times of the page are shown, and sent in UTC.
function nameZones(root) {
  const { timeZone } = Intl.DateTimeFormat().resolvedOptions();
  for (const field of root.querySelectorAll("input[data-local-time]")) {
    field.closest("label").querySelector("[data-zone]").textContent = `When, in your time, ${timeZone}`;
  }
}

document.addEventListener("formdata", ({ target, formData }) => {
  for (const field of target.querySelectorAll("input[data-local-time]")) {
    const typed = new Date(field.value);
    if (!Number.isNaN(typed.getTime())) formData.set(field.name, typed.toISOString());
  }
});

// `/` leads to the search from anywhere, but where somebody types.
document.addEventListener("keydown", (event) => {
  if (event.key !== "/" || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.closest("input, select, textarea, [contenteditable]")) return;
  const field = document.querySelector("[data-search]");
  if (field === null) return;
  event.preventDefault();
  if (field.offsetParent === null) document.getElementById("menu").showPopover(); // on a phone
  field.focus();
  field.select();
});

// A plain form leads to another page: where that says it was taken, what was typed is no draft any more.
const SENT = "statorwatch sent";
function isRefusal(notice) {
  return notice.startsWith("not-");
}
document.addEventListener("submit", ({ target }) => {
  const keys = [...target.querySelectorAll("[data-draft]")].map((field) => field.dataset.draft);
  if (keys.length > 0) sessionStorage.setItem(SENT, JSON.stringify(keys));
});
const done = new URLSearchParams(location.search).get("done");
if (done !== null && !isRefusal(done)) {
  for (const key of JSON.parse(sessionStorage.getItem(SENT) ?? "[]")) sessionStorage.removeItem(DRAFT + key);
}
sessionStorage.removeItem(SENT);

export function say(words) {
  const place = document.getElementById("messages");
  if (place === null) return;
  const message = document.createElement("p");
  message.className = "message bad";
  message.setAttribute("role", "alert");
  message.textContent = words;
  place.replaceChildren(message);
}

document.addEventListener("htmx:afterRequest", ({ detail }) => {
  // The form itself may be gone by now: the answer has taken its place.
  const { elt, verb } = detail.requestConfig;
  const said = new URL(detail.xhr.responseURL || location.href).searchParams.get("done") ?? "";
  if (detail.successful && !isRefusal(said) && verb !== "get" && elt instanceof HTMLFormElement) forgetDrafts(elt);
});
document.addEventListener("htmx:sendError", () => say("The service cannot be reached. What you see may be out of date; nothing was sent."));
document.addEventListener("htmx:load", ({ detail }) => {
  localise(detail.elt.parentElement ?? document);
  restoreDrafts(detail.elt.parentElement ?? document);
  nameZones(detail.elt.parentElement ?? document);
});

localise(document);
restoreDrafts(document);
nameZones(document);
setInterval(() => localise(document), MINUTE_MS / 2);
document.documentElement.dataset.ready = "true";
