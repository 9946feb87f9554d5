"""When what a page is for is on the screen: ours and a peer's, in the same browser."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from playwright.sync_api import Browser, BrowserContext, Page

from benchmarks.reporting import table
from benchmarks.web.answers import Site
from benchmarks.web.home_assistant import DEVICE, serving_home_assistant
from service.api.access.cookies import NAME

TURNS = 7
LOADED = """() => {
    const loaded = ["navigation", "resource"].flatMap((type) => performance.getEntriesByType(type));
    return [performance.now(), loaded.reduce((sum, one) => sum + one.transferSize, 0), loaded.length];
}"""
"""Now, since the page was asked for [ms]; bytes as transferred; files."""


@dataclass(frozen=True, slots=True)
class Shown:
    """Of several loads with an empty cache: when the text was on the screen [s]; bytes and files of one."""

    times_s: Sequence[float]
    bytes: int
    files: int


@dataclass(frozen=True, slots=True)
class Windows:
    """New windows of a browser in which somebody is logged in. enter: logs in."""

    browser: Browser
    enter: Callable[[BrowserContext], None]

    @contextmanager
    def opened(self) -> Iterator[Page]:
        """Open one that was never there."""
        window = self.browser.new_context(viewport={"width": 1280, "height": 800})
        self.enter(window)
        try:
            yield window.new_page()
        finally:
            window.close()

    def shown(self, address: str, text: str) -> Shown:
        """Load an address until a text of what the page is for can be seen, so many times."""
        times_s, size, files = [], 0, 0
        for _ in range(TURNS):
            with self.opened() as page:
                page.goto(address, wait_until="commit")
                page.get_by_text(text).first.wait_for(state="visible", timeout=60_000)
                times_s.append(page.evaluate(LOADED)[0] / 1000)
                page.wait_for_load_state("load")
                _, size, files = page.evaluate(LOADED)
        return Shown(times_s, size, files)


def beside_home_assistant(
    browser: Browser, site: Site, fleet: str, motor: tuple[str, str], command: Path
) -> list[str]:
    """Return a table of our pages and of those of Home Assistant's demo. motor: its name and its path."""
    ours = Windows(browser, partial(_enter, site))
    with serving_home_assistant(command) as peer:
        theirs = Windows(browser, peer.enter)
        with theirs.opened() as page:
            device = peer.path_of_device(page, DEVICE)
        pages = (
            ("StatorWatch: all motors", ours, site.url + fleet, motor[0]),
            ("Home Assistant: all devices", theirs, f"{peer.url}/config/devices/dashboard", DEVICE),
            ("StatorWatch: a motor", ours, site.url + motor[1], "Logbook"),
            ("Home Assistant: a device", theirs, peer.url + device, "Device info"),
        )
        found = [(name, windows.shown(address, text)) for name, windows, address, text in pages]
    rows = [
        (
            name,
            f"{1000 * sorted(one.times_s)[TURNS // 2]:.0f} ms",
            f"{1000 * max(one.times_s):.0f} ms",
            f"{one.bytes / 1000:.0f} kB",
            str(one.files),
        )
        for name, one in found
    ]
    return table(("Page", "Shown after", "Slowest", "With all files", "Files"), rows)


def _enter(site: Site, window: BrowserContext) -> None:
    window.add_cookies([{"name": NAME, "value": site.session, "url": site.url}])
