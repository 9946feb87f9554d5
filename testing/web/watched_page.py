"""A page in a browser, with whatever went wrong in it."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from urllib.parse import urlsplit

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import ConsoleMessage, Page, Request, Response

SERIOUS = ("serious", "critical")
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
ABORTED = "net::ERR_ABORTED"
"""A stream that ends with its page, or a request that another one takes the place of."""

UNANSWERED = ("htmx:afterRequest", "htmx:sendError", "htmx:sendAbort")
"""What htmx says of a request without an answer, which is looked at itself: a reload ends those under way."""

LOAD_FAILED = "Failed to load resource"
"""The browser's word for an answer of 400 or more, which is looked at itself."""


@dataclass
class WatchedPage:
    """A page of one site. `problems` has console errors, refused scripts, failed requests and other hosts.

    accepted: statuses of 400 and more that a test asks for.
    """

    page: Page
    url: str
    problems: list[str] = field(default_factory=list)
    accepted: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.page.on("console", self._hear)
        self.page.on("pageerror", lambda error: self.problems.append(f"script: {error}"))
        self.page.on("request", self._watch)
        self.page.on("requestfailed", self._fail)
        self.page.on("response", self._look)
        self.page.on("dialog", self._refuse_dialog)

    def goto(self, path: str) -> Response:
        """Go to a page of the site and wait for its scripts."""
        response = self.page.goto(self.url + path)
        assert response is not None
        return response

    @property
    def path(self) -> str:
        """Path and query of the page."""
        parts = urlsplit(self.page.url)
        return parts.path + (f"?{parts.query}" if parts.query else "")

    @contextmanager
    def accepting(self, *statuses: int) -> Iterator[None]:
        """Take answers of these statuses for right."""
        before = set(self.accepted)
        self.accepted |= set(statuses)
        yield
        self.accepted = before

    def require_quiet(self) -> None:
        """Fail where something went wrong so far."""
        assert not self.problems, "\n".join(self.problems)

    def require_accessible(self) -> None:
        """Fail where axe-core finds something serious or critical."""
        options = {"runOnly": {"type": "tag", "values": RULES}, "resultTypes": ["violations"]}
        found = Axe().run(self.page, options=options).response["violations"]
        serious = [
            f"{one['id']} ({one['impact']}): {one['help']}: {node['target']} {node['html'][:200]}"
            f" {node.get('failureSummary', '')}"
            for one in found
            if one["impact"] in SERIOUS
            for node in one["nodes"][:3]
        ]
        assert not serious, "\n".join([self.path, *serious])

    def require_series_told_apart_without_colours(self) -> None:
        """Fail where two series of a chart have the same line or the same shape."""
        alike = self.page.evaluate(ALIKE_SERIES)
        assert not alike, f"{self.path}: {alike}"

    def require_no_sideways_scroll(self) -> None:
        """Fail where the page is wider than the window."""
        wide = self.page.evaluate(WIDE_ELEMENTS)
        assert not wide, f"{self.path} is wider than the window: {wide}"

    def _hear(self, message: ConsoleMessage) -> None:
        accepted = re.match(r"Response Status Error Code (\d+)", message.text)  # of htmx
        if accepted and int(accepted[1]) in self.accepted:
            return
        if (
            message.type == "error"
            and LOAD_FAILED not in message.text
            and not message.text.startswith(UNANSWERED)
        ):
            self.problems.append(f"console: {message.text}")

    def _watch(self, request: Request) -> None:
        parts = urlsplit(request.url)
        if parts.scheme in ("http", "https", "ws", "wss") and not request.url.startswith(self.url + "/"):
            self.problems.append(f"request to another host: {request.url}")

    def _fail(self, request: Request) -> None:
        if request.failure != ABORTED:
            self.problems.append(f"request failed: {request.url}: {request.failure}")

    def _look(self, response: Response) -> None:
        if response.status >= 400 and response.status not in self.accepted:
            self.problems.append(f"{response.status} of {response.request.method} {response.url}")

    def _refuse_dialog(self, dialog: object) -> None:
        self.problems.append("a dialog opened")
        dialog.dismiss()  # type: ignore[attr-defined]  # Playwright gives the event's argument no type


ALIKE_SERIES = """() => [...document.querySelectorAll("figure[data-chart]")].flatMap((figure) => {
    const data = document.getElementById(figure.dataset.chart);
    if (data === null || JSON.parse(data.textContent).rows) return [];  // states have a row each
    const legend = figure.querySelectorAll("[data-chart-legend] button svg");
    const samples = [...legend].map((one) => one.outerHTML);
    const differ = new Set(samples).size === samples.length;
    return differ ? [] : [`${figure.dataset.chartName}: ${samples.join(" ")}`];
})"""
"""Charts in which two series look alike but for their colours, with the samples of their legends."""

WIDE_ELEMENTS = """() => {
    const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
    if (wide <= 1) return null;
    const scrolls = (element) => {
        for (let one = element; one; one = one.parentElement)
            if (["auto", "scroll", "hidden", "clip"].includes(getComputedStyle(one).overflowX)) return true;
        return false;
    };
    const beyond = [...document.body.querySelectorAll("*")].filter(
        (one) => one.getBoundingClientRect().right > innerWidth + 1 && !scrolls(one));
    return `${wide} px: ` + beyond.slice(0, 5).map((one) => one.outerHTML.slice(0, 120)).join(" | ");
}"""
"""What reaches beyond the right side of the window; null where nothing does."""
