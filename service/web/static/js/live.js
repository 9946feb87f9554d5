// Live updates for the SSE extension of htmx. A page that nobody looks at gives its connection back, because a
// browser has six for a site; when it is looked at again, the service tells what has changed since.

const FIRST_PAUSE_MS = 2_000;
const LONGEST_PAUSE_MS = 60_000;
const TOLD_AFTER_MS = 8_000;

/** How often each change was told, by the name of its event. */
const told = new Map();

/** How often it had been told when a request for it began. */
const toldBefore = new WeakMap();

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
      told.set(`sse:${name}`, (told.get(`sse:${name}`) ?? 0) + 1);
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

document.addEventListener("htmx:beforeSend", ({ detail }) => {
  const name = detail.requestConfig.triggeringEvent?.type;
  if (told.has(name)) toldBefore.set(detail.xhr, told.get(name));
});

// What is told while the answer is under way may not be in it. htmx would ask again for the element that the
// answer has replaced; the one in its place asks.
document.addEventListener("htmx:afterRequest", ({ detail }) => {
  const name = detail.requestConfig.triggeringEvent?.type;
  if (!toldBefore.has(detail.xhr) || toldBefore.get(detail.xhr) === told.get(name)) return;
  const { id } = detail.requestConfig.elt;
  setTimeout(() => {
    const element = document.getElementById(id);
    if (element === null) return;
    htmx.process(element);
    htmx.trigger(element, name);
  });
});
