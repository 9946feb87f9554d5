// @ts-check
/** What each line is called, at its end: nobody has to look from a legend to a line and back. */

/** @typedef {import("./description.js").SeriesDescription} SeriesDescription */

const LETTERING = 11;
const STEP = 12; // CSS pixels between names

/** Lines that have a name: not bands alone, not points, not states in rows. @param {import("./description.js").Description} description */
export function labelled({ series, rows }) {
  if (rows) return false;
  return series.filter(hasName).length > 0;
}

/** @param {SeriesDescription} one */
function hasName({ kind, values }) {
  if (kind === "points") return false;
  return Array.prototype.some.call(values, (value) => value !== null);
}

/**
 * Write the names of the lines that are seen beside where they end, or within where there is no room beside.
 * @param {any} plot
 * @param {import("./description.js").Description} description
 * @param {Set<string>} hidden
 * @param {import("./theme.js").Theme} theme
 * @param {number} room beside the plot [CSS px]
 */
export function nameLines(plot, description, hidden, theme, room) {
  if (description.rows) return;
  const { ctx, bbox: box } = plot;
  const ratio = plot.pxRatio ?? window.devicePixelRatio;
  const named = description.series.filter((one) => hasName(one) && !hidden.has(one.label));
  if (named.length < 2 && room === 0) return; // the caption says what it is
  const places = named.flatMap((one) => {
    const value = lastWithin(one.values, description.x.values, plot.scales.x);
    if (value === null) return [];
    const y = Math.min(Math.max(plot.valToPos(value, "y", true), box.top + LETTERING * ratio), box.top + box.height);
    return [{ one, y }];
  });
  places.sort((first, second) => first.y - second.y);
  for (let at = 1; at < places.length; at += 1) places[at].y = Math.max(places[at].y, places[at - 1].y + STEP * ratio);
  const over = places.length > 0 ? places[places.length - 1].y - (box.top + box.height) : 0;
  if (over > 0) for (const place of places) place.y -= over;
  ctx.save();
  ctx.font = `${LETTERING * ratio}px ${getComputedStyle(document.body).fontFamily}`;
  ctx.textAlign = room > 0 ? "left" : "right";
  const x = box.left + box.width + (room > 0 ? 4 : -4) * ratio;
  for (const { one, y } of places) {
    const name = one.short ?? one.label;
    if (room === 0) {
      const wide = ctx.measureText(name).width;
      ctx.fillStyle = theme.of("surface");
      ctx.fillRect(x - wide - 2 * ratio, y - LETTERING * ratio, wide + 4 * ratio, (LETTERING + 2) * ratio);
    }
    ctx.fillStyle = theme.of(one.tone);
    ctx.fillText(name, x, y, room > 0 ? (room - 6) * ratio : undefined);
  }
  ctx.restore();
}

/** The last value of what is seen. @param {ArrayLike<number|null>} values @param {ArrayLike<number>} xs @param {{min: number, max: number}} scale */
function lastWithin(values, xs, { min, max }) {
  for (let at = values.length - 1; at >= 0; at -= 1) {
    if (values[at] !== null && xs[at] >= min && xs[at] <= max) return values[at];
  }
  return null;
}
