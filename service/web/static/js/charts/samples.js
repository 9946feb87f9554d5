// @ts-check
/** Binary samples of a recording (docs/reference/api.md): a head in JSON, and columns of single-precision numbers. */

/** @typedef {{of: string, name?: string, phase?: string|null, group?: string, unit: string}} Column */

/** @param {ArrayBuffer} content */
export function decoded(content) {
  const length = new DataView(content).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(content, 4, length)));
  const columns = head.columns.map((/** @type {Column} */ _, /** @type {number} */ number) =>
    withGaps(new Float32Array(content, 4 + length + 4 * number * head.count, head.count)),
  );
  return new Samples(head, columns);
}

/** A chart takes null for a gap. @param {Float32Array} values @returns {ArrayLike<number | null>} */
function withGaps(values) {
  return values.some(Number.isNaN) ? Array.from(values, (value) => (Number.isNaN(value) ? null : value)) : values;
}

export class Samples {
  /** @param {any} head @param {ArrayLike<any>[]} columns */
  constructor(head, columns) {
    this.head = head;
    this.columns = columns;
    /** Seconds after the first sample of the recording. @type {number[]} */
    this.times = Array.from(columns[0], (time) => head.first_s + time);
    this.isEnvelope = head.columns.some((/** @type {Column} */ one) => one.of === "minimum");
  }

  /** @param {string} of @param {string} name @param {string|null} [phase] */
  #find(of, name, phase) {
    const number = this.head.columns.findIndex(
      (/** @type {Column} */ one) => one.of === of && one.name === name && (phase === undefined || one.phase === phase),
    );
    return number < 0 ? undefined : this.columns[number];
  }

  /** The same series with the values of this part. @param {any} series */
  finer(series) {
    return this.column(series.label, series, null);
  }

  /** @param {string} name @param {any} series @param {string|null} [phase] */
  column(name, series, phase = series.tone) {
    const { low: _low, high: _high, ...about } = series;
    const which = phase === null ? undefined : phase;
    const values = this.#find("value", name, which);
    if (values) return { ...about, kind: "line", values };
    const low = this.#find("minimum", name, which);
    const high = this.#find("maximum", name, which);
    if (!low || !high) return { ...about, values: this.times.map(() => null) };
    const middle = Array.from(low, (value, number) => (value === null ? null : (value + high[number]) / 2));
    return { ...about, kind: "envelope", values: middle, low, high };
  }

  /** Values of a column at other times of the same samples; null where it has none. */
  at(/** @type {string} */ name, /** @type {string} */ phase, /** @type {ArrayLike<number>} */ times) {
    const values = this.#find("value", name, phase) ?? [];
    const step = (this.times[this.times.length - 1] - this.times[0]) / (this.times.length - 1);
    return Array.from(times, (time) => {
      const number = Math.round((time - this.times[0]) / step);
      return number >= 0 && number < values.length ? values[number] : null;
    });
  }
}
