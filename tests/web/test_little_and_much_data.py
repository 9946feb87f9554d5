"""Pages of a plant of which nothing is known yet, and of one with 500 motors."""

import re
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from benchmarks.web.filling import Plan, fill
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect
from testing.service.database import make_database
from testing.web.pages import address_of, is_page, page_routes, roles_for
from testing.web.seeding import demo_plant
from testing.web.site import PHONE, Site, running_site

MOST_BYTES = 250_000
"""Of the first page, as transferred, with all its files."""

TRANSFERRED = """() => ["navigation", "resource"].flatMap((type) => performance.getEntriesByType(type))
    .reduce((sum, one) => sum + one.transferSize, 0)"""


@pytest.fixture(scope="module")
def unknown(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Site]:
    """A site that has just started for the first time, with no relay that has answered."""
    data: Path = tmp_path_factory.mktemp("unknown")
    make_database(data)
    engine = connect(sqlite_url(data))
    Repository(engine).sync_plant(demo_plant(), noted_ns=time.time_ns())
    engine.dispose()
    with running_site(data, browser) as site:
        yield site


@pytest.mark.parametrize("route", page_routes())
def test_a_page_without_data_says_so(unknown: Site, route: str) -> None:
    path = address_of(route, unknown.repository)
    if path is None or not is_page(unknown.url, path, unknown.log_in(*roles_for(path))):
        return
    page = unknown.open(*roles_for(path), screen=PHONE)
    page.goto(path)
    page.page.wait_for_function("() => document.documentElement.dataset.ready === 'true'")
    words = page.page.locator("main").inner_text()
    wrong = re.search(r"\b(None(?! yet)|nan|NaN|undefined|inf)\b", words)
    assert wrong is None, f"{path} shows {wrong}"
    page.require_no_sideways_scroll()
    page.require_accessible()
    page.require_quiet()
    page.page.context.close()


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Site]:
    """A site of 500 motors, one of them with 100,000 records."""
    data: Path = tmp_path_factory.mktemp("large")
    fill(sqlite_url(data), Plan(500, 40, time.time_ns()))
    with running_site(data, browser) as site:
        yield site


@pytest.mark.campaign
@pytest.mark.timeout(600)
@pytest.mark.parametrize("route", page_routes())
def test_a_page_of_500_motors_is_whole(large: Site, route: str) -> None:
    path = address_of(route, large.repository)
    if path is None or not is_page(large.url, path, large.log_in(*roles_for(path))):
        return
    page = large.open(*roles_for(path), screen=PHONE)
    page.goto(path)
    page.require_no_sideways_scroll()
    if path == "/":
        assert page.page.locator("table.fleet tbody tr").count() == 500
        assert 0 < page.page.evaluate(TRANSFERRED) <= MOST_BYTES
    page.require_quiet()
    page.page.context.close()
