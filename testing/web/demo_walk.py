"""The way of a newcomer: from `mcc demo` to which motor, since when and what to do, in a real browser."""

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

from playwright.sync_api import Browser

from testing.web.site import PHONE, Screen
from testing.web.watched_page import WatchedPage

PAGE = "page: "
LIMIT_MS = 180_000
"""On a machine that does much else; the walk tells how long it took."""


@dataclass(frozen=True, slots=True)
class Step:
    """What somebody did and saw, with how many clicks, after how long [s]."""

    words: str
    clicks: int
    seconds: float


@dataclass
class Walk:
    """The steps of one walk."""

    steps: list[Step] = field(default_factory=list)
    _since_s: float = field(default_factory=time.monotonic)

    def step(self, words: str, clicks: int = 0) -> None:
        """Note that somebody has come so far."""
        now_s = time.monotonic()
        self.steps.append(Step(words, clicks, now_s - self._since_s))
        self._since_s = now_s

    @property
    def clicks(self) -> int:
        return sum(step.clicks for step in self.steps)

    @property
    def seconds(self) -> float:
        return sum(step.seconds for step in self.steps)


@dataclass(frozen=True)
class Demo:
    """A demo that runs. first_line: what it printed first."""

    process: "subprocess.Popen[str]"
    first_line: str

    def next_link(self) -> str:
        """Return the next link that the demo prints."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            if line.startswith(PAGE):
                return line.removeprefix(PAGE).strip()
        raise AssertionError("the demo ended")


@contextmanager
def running_demo(data: Path) -> Iterator[Demo]:
    """`mcc demo` in a process of its own, until the block ends."""
    command = [sys.executable, "-m", "service.cli", "demo", "--data", str(data)]
    with (
        (data / "demo.err").open("w") as errors,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True) as process,
    ):
        try:
            assert process.stdout is not None
            yield Demo(process, process.stdout.readline().rstrip("\n"))
        finally:
            process.terminate()
            process.wait(60)


def follow(browser: Browser, link: str, screen: Screen, *, dark: bool = False) -> WatchedPage:
    """Open a link that logs in, and return the first page, where it leads to."""
    width, height = screen
    window = browser.new_context(
        viewport={"width": width, "height": height},
        color_scheme="dark" if dark else "light",
        has_touch=width < 600,
        locale="en-GB",
    )
    parts = urlsplit(link)
    page = WatchedPage(window.new_page(), f"{parts.scheme}://{parts.netloc}")
    page.page.goto(link)
    page.page.get_by_role("heading", level=1, name="Fleet").wait_for(timeout=LIMIT_MS)
    return page


@contextmanager
def on_a_phone(browser: Browser, page: WatchedPage) -> Iterator[WatchedPage]:
    """A page on a phone with the login of another page."""
    width, height = PHONE
    with browser.new_context(
        viewport={"width": width, "height": height},
        has_touch=True,
        locale="en-GB",
        storage_state=page.page.context.storage_state(),
    ) as window:
        yield WatchedPage(window.new_page(), page.url)


def find_what_to_do(page: WatchedPage, walk: Walk) -> str:
    """Go from the first page to the motor that needs attention first, and take notice; return its name.

    The fleet tells which, since when and what to do by itself. The motor's page says how that is known.
    """
    row = page.page.locator("table.fleet tbody tr.fault").first
    row.wait_for(timeout=LIMIT_MS)
    words = row.inner_text()
    walk.step("the first page names the motor, its state, since when, its level and what to do")
    assert "since" in words, words
    link = row.locator("th a").first
    name = link.inner_text()
    link.click()
    page.page.locator("#verdict .advice").wait_for(timeout=LIMIT_MS)
    walk.step(f"the page of {name} says it in a sentence, with the trend below", clicks=1)
    assert "%" in page.page.locator("#verdict .sentence").inner_text()
    button = page.page.get_by_role("button", name="Acknowledge").first
    button.wait_for(timeout=LIMIT_MS)
    button.click()
    page.page.get_by_text("cknowledged").first.wait_for(timeout=LIMIT_MS)
    walk.step("the alarm is acknowledged", clicks=1)
    page.require_quiet()
    return name


STANDING = "PUMP-B3"
LISTS = ("/alarms", "/relays", "/recordings", "/plant", "/reports")
FOR_PEOPLE = ("/notifications", "/people", "/account")
OF_ONE = {"/alarms": "/alarms/", "/relays": "/relays/", "/recordings": "/recordings/"}
"""Lists, and how addresses of what they list begin."""


def look_at_every_page(page: WatchedPage, motor: str) -> list[str]:
    """Open each page once a motor is known to stand still; return those that were opened.

    motor: one that has a fault.  Raises AssertionError where a page has nothing to show.
    """
    page.goto("/")
    standing = page.page.locator("table.fleet tbody tr", has_text=STANDING)
    standing.get_by_text("not running").first.wait_for(timeout=LIMIT_MS)
    opened = ["/", f"/motors/{motor}", f"/motors/{motor}/load", *LISTS, *FOR_PEOPLE]
    for path in opened:
        page.goto(path)
        words = page.page.locator("main").inner_text()
        assert words.count("\n") > 4, f"{path} has nothing to show: {words}"
        if path in OF_ONE:
            link = page.page.locator(f"main a[href^='{OF_ONE[path]}']").first
            page.goto(link.get_attribute("href") or "")
            assert page.page.locator("main h1").inner_text()
    page.goto("/starts")
    page.page.locator("main").get_by_role("link", name="PUMP-A1").first.wait_for(timeout=LIMIT_MS)
    page.require_quiet()
    return [*opened, *OF_ONE.values(), "/starts"]
