"""Every page of the large plant, looked at as the browser tests look at those of a small one."""

from collections.abc import Iterator

from playwright.sync_api import Browser

from benchmarks.web.answers import Site
from service.api.access.cookies import NAME
from service.storage import Repository
from testing.web.pages import address_of, is_page, page_routes, roles_for
from testing.web.site import DESKTOP, PHONE, log_in
from testing.web.watched_page import WatchedPage

READY = "() => document.documentElement.dataset.ready === 'true'"


def faults_of_pages(browser: Browser, site: Site, repository: Repository) -> Iterator[tuple[str, list[str]]]:
    """Yield the path of each page, and what is wrong with it on a desktop and on a phone.

    Console errors, refused scripts and failed or foreign requests, what axe-core finds serious, and a page
    that is wider than its window.
    """
    for route in page_routes():
        path = address_of(route, repository)
        if path is None:
            continue
        session = log_in(repository, *roles_for(path))
        if is_page(site.url, path, session):
            found = [_faults(browser, site.url, session, path, screen) for screen in (DESKTOP, PHONE)]
            yield path, [fault for faults in found for fault in faults]


def _faults(browser: Browser, url: str, session: str, path: str, screen: tuple[int, int]) -> list[str]:
    width, height = screen
    window = browser.new_context(viewport={"width": width, "height": height}, has_touch=width < 600)
    window.add_cookies([{"name": NAME, "value": session, "url": url}])
    watched = WatchedPage(window.new_page(), url)
    try:
        watched.goto(path)
        watched.page.wait_for_function(READY)
        found = []
        for require in (
            watched.require_no_sideways_scroll,
            watched.require_accessible,
            watched.require_series_told_apart_without_colours,
            watched.require_quiet,
        ):
            try:
                require()
            except AssertionError as fault:
                found.append(f"{width} px: {fault}")
        return found
    finally:
        window.close()
