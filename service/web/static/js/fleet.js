// A live update of the fleet touches the rows that differ, so that focus, selection and scroll stay.

import { localise } from "./page.js";

function byItself(detail) {
  return detail.requestConfig.triggeringEvent?.type.startsWith("sse:") ?? false;
}

/** Give a table body the rows of another one, in their order; rows with the same key stay as they are. */
function take(body, fresh) {
  const present = new Map([...body.rows].map((row) => [row.id, row]));
  let at = body.firstElementChild;
  for (const row of [...fresh.rows]) {
    const before = present.get(row.id);
    present.delete(row.id);
    if (before !== undefined && before.dataset.key === row.dataset.key) {
      if (before === at) at = at.nextElementSibling;
      else body.insertBefore(before, at);
    } else {
      if (before !== undefined && before === at) at = at.nextElementSibling;
      before?.remove();
      body.insertBefore(document.adoptNode(row), at);
    }
  }
  for (const row of present.values()) row.remove();
}

document.addEventListener("htmx:beforeSwap", ({ detail }) => {
  if (detail.target.id !== "fleet" || detail.xhr.status !== 200 || !byItself(detail)) return;
  const fresh = new DOMParser().parseFromString(detail.serverResponse, "text/html");
  const table = detail.target.querySelector("table");
  const freshTable = fresh.querySelector("#fleet table");
  if (table === null || freshTable === null) return;
  detail.shouldSwap = false;
  const focused = document.activeElement?.id;
  take(table.tBodies[0], freshTable.tBodies[0]);
  table.caption.textContent = freshTable.caption.textContent;
  const summary = document.getElementById("summary");
  const freshSummary = fresh.getElementById("summary");
  if (summary.dataset.key !== freshSummary.dataset.key) summary.replaceWith(document.adoptNode(freshSummary));
  if (focused && document.activeElement?.id !== focused) document.getElementById(focused)?.focus({ preventScroll: true });
  localise(document);
});

// On a phone the motors stand on the first screen; filters that are in use stay seen.
if (matchMedia("(max-width: 40rem)").matches && location.search === "") document.querySelector("details.filters")?.removeAttribute("open");
