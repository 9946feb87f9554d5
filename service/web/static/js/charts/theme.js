// @ts-check
/** Colours of the theme for a canvas, which does not follow CSS by itself. */

/** @typedef {{of: (tone: string) => string, faint: (tone: string) => string}} Theme */

const FAINT = 0.25;
const dark = window.matchMedia("(prefers-color-scheme: dark)");
/** @type {Set<() => void>} */
const listeners = new Set();

/** Call a function whenever the theme changes. @param {() => void} listener */
export function onThemeChange(listener) {
  listeners.add(listener);
}

const tell = () => {
  for (const listener of listeners) listener();
};
dark.addEventListener("change", tell);
new MutationObserver(tell).observe(document.documentElement, { attributeFilter: ["data-theme"] });

/** The colours as they are now, each read once: `--tone` of the page, for "a", "b" and "c" `--phase-a` and so on. @returns {Theme} */
export function colours() {
  known ??= read();
  return known;
}

/** @type {Theme | null} */
let known = null;
onThemeChange(() => (known = null)); // before anybody draws anew

/** @returns {Theme} */
function read() {
  const style = getComputedStyle(document.documentElement);
  const of = once((tone) => {
    const name = /^[abcn]$/.test(tone) ? `--phase-${tone}` : `--${tone}`;
    return style.getPropertyValue(name).trim() || style.getPropertyValue("--ink").trim() || style.color;
  });
  return { of, faint: once((tone) => withOpacity(of(tone), FAINT)) };
}

/** @param {(tone: string) => string} work @returns {(tone: string) => string} */
function once(work) {
  /** @type {Map<string, string>} */
  const found = new Map();
  return (tone) => {
    const before = found.get(tone);
    if (before !== undefined) return before;
    const colour = work(tone);
    found.set(tone, colour);
    return colour;
  };
}

const probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });

/** @param {string} colour @param {number} opacity */
function withOpacity(colour, opacity) {
  if (!probe) return colour;
  probe.clearRect(0, 0, 1, 1);
  probe.fillStyle = colour;
  probe.fillRect(0, 0, 1, 1);
  const [red, green, blue] = probe.getImageData(0, 0, 1, 1).data;
  return `rgba(${red}, ${green}, ${blue}, ${opacity})`;
}
