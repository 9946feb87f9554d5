// @ts-check
/** What lies over the lines of a chart: limits, marks of events, and markers that somebody has set. */

const LETTERING = 11;

/**
 * Grounds between values of y, below the lines of the chart.
 * @param {any} plot
 * @param {import("./description.js").Description} description
 * @param {import("./theme.js").Theme} theme
 */
export function bands(plot, { bands: grounds }, theme) {
  const { ctx, bbox: box } = plot;
  const ratio = plot.pxRatio ?? window.devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(box.left, box.top, box.width, box.height);
  ctx.clip();
  ctx.font = `${LETTERING * ratio}px ${getComputedStyle(document.body).fontFamily}`;
  for (const { low, high, label, tone } of grounds ?? []) {
    const [top, bottom] = [plot.valToPos(high, "y", true), plot.valToPos(low, "y", true)];
    ctx.fillStyle = theme.of("band");
    ctx.fillRect(box.left, top, box.width, bottom - top);
    ctx.fillStyle = theme.of(tone);
    ctx.textAlign = "left";
    ctx.fillText(label, box.left + 4 * ratio, Math.min(bottom, box.top + box.height) - 4 * ratio);
  }
  ctx.restore();
}

/**
 * @param {any} plot
 * @param {import("./description.js").Description} description
 * @param {number[]} markers
 * @param {import("./theme.js").Theme} theme
 */
export function limitsAndMarks(plot, description, markers, theme) {
  const { ctx } = plot;
  const ratio = plot.pxRatio ?? window.devicePixelRatio;
  const box = plot.bbox;
  ctx.save();
  ctx.beginPath();
  ctx.rect(box.left, box.top, box.width, box.height);
  ctx.clip();
  ctx.font = `${LETTERING * ratio}px ${getComputedStyle(document.body).fontFamily}`;
  ctx.lineWidth = ratio;
  /** @type {{base: number, end: number}[]} */
  const labels = [];
  for (const limit of description.limits ?? []) {
    const y = plot.valToPos(limit.y, "y", true);
    stroke(ctx, theme.of(limit.tone), [4, 3], ratio, [box.left, y], [box.left + box.width, y]);
    ctx.textAlign = "left";
    const wide = ctx.measureText(limit.label).width;
    const above = y - box.top > 1.5 * LETTERING * ratio;
    const base = above ? y - 4 * ratio : y + (LETTERING + 2) * ratio;
    const beside = labels.filter((one) => Math.abs(one.base - base) < 1.3 * LETTERING * ratio);
    const begin = Math.max(box.left, ...beside.map((one) => one.end)) + 4 * ratio;
    labels.push({ base, end: begin + wide + 4 * ratio });
    ctx.fillStyle = theme.of("surface"); // a ground: the label may lie over lines of the chart
    ctx.fillRect(begin - 2 * ratio, base - LETTERING * ratio, wide + 4 * ratio, (LETTERING + 2) * ratio);
    ctx.fillStyle = theme.of(limit.tone);
    ctx.fillText(limit.label, begin, base);
  }
  let rightmost = -Infinity;
  for (const mark of description.marks ?? []) {
    const x = plot.valToPos(mark.x, "x", true);
    stroke(ctx, theme.of(mark.tone), [2, 2], ratio, [x, box.top], [x, box.top + box.height]);
    // Labels that would lie over one another stand in the list beneath the chart alone.
    if (x < rightmost || x < box.left || x > box.left + box.width) continue;
    ctx.textAlign = "left";
    const width = ctx.measureText(mark.label).width;
    ctx.fillStyle = theme.of("surface"); // a ground: the label may lie over lines of the chart
    ctx.fillRect(x + ratio, box.top, width + 4 * ratio, 1.4 * LETTERING * ratio);
    ctx.fillStyle = theme.of(mark.tone);
    ctx.fillText(mark.label, x + 3 * ratio, box.top + LETTERING * ratio);
    rightmost = x + width + 6 * ratio;
  }
  markers.forEach((at, number) => {
    const x = plot.valToPos(at, "x", true);
    stroke(ctx, theme.of("accent"), [], ratio, [x, box.top], [x, box.top + box.height]);
    ctx.textAlign = "left";
    ctx.fillText(String(number + 1), x + 3 * ratio, box.top + box.height - 4 * ratio);
  });
  ctx.restore();
}

/**
 * @param {CanvasRenderingContext2D} ctx @param {string} colour @param {number[]} dashes @param {number} ratio
 * @param {[number, number]} from @param {[number, number]} to
 */
function stroke(ctx, colour, dashes, ratio, from, to) {
  ctx.strokeStyle = colour;
  ctx.fillStyle = colour;
  ctx.setLineDash(dashes.map((one) => one * ratio));
  ctx.beginPath();
  ctx.moveTo(...from);
  ctx.lineTo(...to);
  ctx.stroke();
}
