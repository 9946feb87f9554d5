// Live updates for the SSE extension of htmx. A page that nobody looks at gives its connection back, because a
// browser has six for a site; when it is looked at again, the service tells what has changed since.

const FIRST_PAUSE_MS = 2_000;
const LONGEST_PAUSE_MS = 60_000;
const TOLD_AFTER_MS = 8_000;

/** A stream of events that rests while the page is hidden, and comes back by itself. */
class LiveSource extends EventTarget {
  onopen = null;
  onerror = null;
  #address;
  #source = null;
  #seen = null;
  #names = new Set();
  #isClosed = false;
  #pauseMs = FIRST_PAUSE_MS;
  #timer = 0;
  #notice = 0;

  constructor(address) {
    super();
    this.#address = address;
    document.addEventListener("visibilitychange", this.#look);
    addEventListener("pagehide", this.#rest);
    addEventListener("pageshow", this.#look);
    this.#look();
  }

  get readyState() {
    if (this.#isClosed) return EventSource.CLOSED;
    return this.#source?.readyState === EventSource.OPEN ? EventSource.OPEN : EventSource.CONNECTING;
  }

  addEventListener(name, ...others) {
    super.addEventListener(name, ...others);
    if (this.#names.has(name)) return;
    this.#names.add(name);
    if (this.#source !== null) this.#hear(name);
  }

  close() {
    this.#isClosed = true;
    this.#rest();
    document.removeEventListener("visibilitychange", this.#look);
    removeEventListener("pagehide", this.#rest);
    removeEventListener("pageshow", this.#look);
  }

  #look = () => {
    if (document.hidden) this.#rest();
    else if (this.#source === null && !this.#isClosed) this.#open();
  };

  #rest = () => {
    clearTimeout(this.#timer);
    this.#source?.close();
    this.#source = null;
    this.#tell(true);
  };

  #open() {
    const address = new URL(this.#address, location.href);
    if (this.#seen !== null) address.searchParams.set("seen", this.#seen);
    const source = new EventSource(address);
    this.#source = source;
    source.onopen = (event) => {
      this.#pauseMs = FIRST_PAUSE_MS;
      this.#tell(true);
      this.onopen?.(event);
    };
    source.onerror = () => {
      this.#tell(false);
      if (source.readyState !== EventSource.CLOSED || this.#source !== source) return;
      this.#source = null; // it was refused: the browser does not try again by itself
      this.#timer = setTimeout(this.#look, this.#pauseMs);
      this.#pauseMs = Math.min(2 * this.#pauseMs, LONGEST_PAUSE_MS);
    };
    for (const name of this.#names) this.#hear(name);
  }

  #hear(name) {
    this.#source.addEventListener(name, ({ data, lastEventId }) => {
      if (lastEventId !== "") this.#seen = lastEventId;
      this.dispatchEvent(new MessageEvent(name, { data, lastEventId }));
    });
  }

  /** Say that the page may be out of date, once that has lasted. */
  #tell(isWell) {
    clearTimeout(this.#notice);
    const place = document.getElementById("live-state");
    if (place === null) return;
    if (isWell) place.hidden = true;
    else this.#notice = setTimeout(() => (place.hidden = false), TOLD_AFTER_MS);
  }
}

htmx.createEventSource = (address) => new LiveSource(address);

// What a page asks for by itself is no use of the session: nobody may be there any more.
document.addEventListener("htmx:configRequest", ({ detail }) => {
  if (detail.triggeringEvent?.type.startsWith("sse:")) detail.headers["X-Refresh"] = "1";
});
