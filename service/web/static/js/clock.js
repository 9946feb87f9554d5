// @ts-check
/** Times as pages and charts write them: 2026-01-31 13:00, in the viewer's zone. */

/** @param {number} number */
const two = (number) => String(number).padStart(2, "0");

/** @param {Date} date @param {boolean} [hasSeconds] */
export function clock(date, hasSeconds = false) {
  const day = `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())}`;
  return `${day} ${two(date.getHours())}:${two(date.getMinutes())}${hasSeconds ? `:${two(date.getSeconds())}` : ""}`;
}

/** How far the zone is ahead of UTC at a time: +01:00. @param {Date} date */
export function offset(date) {
  const ahead = -date.getTimezoneOffset();
  if (ahead === 0) return "UTC";
  return `${ahead < 0 ? "-" : "+"}${two(Math.floor(Math.abs(ahead) / 60))}:${two(Math.abs(ahead) % 60)}`;
}
