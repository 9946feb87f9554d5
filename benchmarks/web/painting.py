"""What a browser does with a page: when it first paints, and how much it fetches with an empty cache."""

from collections.abc import Sequence
from dataclasses import dataclass

from playwright.sync_api import Browser

from benchmarks.web.answers import Site
from service.api.access.cookies import NAME

FIGURES = """() => {
    const paint = performance.getEntriesByName("first-contentful-paint")[0];
    const loaded = ["navigation", "resource"].flatMap((type) => performance.getEntriesByType(type));
    const bytes = loaded.reduce((sum, one) => sum + one.transferSize, 0);
    const charts = performance.getEntriesByName("charts: first paint")[0];
    return [paint ? paint.startTime : -1, bytes, loaded.length, charts ? charts.duration : null];
}"""
"""First contentful paint [ms], bytes as transferred with their headers, files, and charts drawn [ms]."""

PAINTED = """() => performance.getEntriesByName('first-contentful-paint').length > 0
    && performance.getEntriesByName('charts: data').length
        === performance.getEntriesByName('charts: first paint').length"""


@dataclass(frozen=True, slots=True)
class Painting:
    """Of several loads of a page: their first contentful paints [s], and what one of them fetched.

    charts_s: from the charts' data in the page to their lines on the screen; empty for pages without charts.
    """

    first_s: Sequence[float]
    charts_s: Sequence[float]
    bytes: int
    files: int

    @property
    def slowest_s(self) -> float:
        return max(self.first_s)

    @property
    def charts_median_s(self) -> float | None:
        """Middle of the times in which charts are drawn; None for a page without any."""
        return sorted(self.charts_s)[len(self.charts_s) // 2] if self.charts_s else None

    @property
    def median_s(self) -> float:
        return sorted(self.first_s)[len(self.first_s) // 2]


def painting(browser: Browser, site: Site, path: str, *, turns: int = 7) -> Painting:
    """Load a page so many times, each time as a browser that was never there."""
    first_s: list[float] = []
    charts_s: list[float] = []
    size = files = 0
    for _ in range(turns):
        window = browser.new_context(viewport={"width": 1280, "height": 800})
        window.add_cookies([{"name": NAME, "value": site.session, "url": site.url}])
        page = window.new_page()
        page.goto(site.url + path, wait_until="load")
        page.wait_for_function(PAINTED)
        paint_ms, size, files, charts_ms = page.evaluate(FIGURES)
        first_s.append(paint_ms / 1000)
        if charts_ms is not None:
            charts_s.append(charts_ms / 1000)
        window.close()
    return Painting(first_s, charts_s, size, files)
