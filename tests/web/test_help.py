"""The help pages in a browser: they work under the policy of the service, and their search finds a term."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from release.help_site import build
from service.storage.records import Role
from testing.web.site import PHONE, Site, running_site
from tests.docs.pages import ROOT


@pytest.fixture(scope="module")
def helpful(seeded: Path, tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Site]:
    """A site with the help pages of this tree; nothing may have gone wrong in its pages."""
    folder = tmp_path_factory.mktemp("help")
    build(ROOT, folder)
    with running_site(seeded, browser, help_folder=folder) as site:
        yield site
        problems = site.close_pages()
        assert not problems, "\n".join(problems)


def test_a_page_of_the_product_leads_to_the_passage_that_explains_it(helpful: Site) -> None:
    page = helpful.open(Role.VIEWER)
    page.goto("/")
    page.page.get_by_role("link", name="Help: fleet").click()
    expect(page.page.get_by_role("heading", level=1)).to_contain_text("The fleet page")
    page.page.get_by_role("link", name="StatorWatch help").first.click()
    expect(page.page.get_by_role("heading", level=1, name="Fleet")).to_be_visible()


def test_an_anchor_is_in_sight(helpful: Site) -> None:
    page = helpful.open()
    page.goto("/help/reference/losses.html#over-time")
    expect(page.page.locator("#over-time")).to_be_in_viewport()


def test_the_search_finds_a_term(helpful: Site) -> None:
    page = helpful.open()
    page.goto("/help/")
    page.page.get_by_role("textbox", name="Search").fill("detection limit")
    found = page.page.locator(".md-search-result__link[href*='?h=detection+limit']").first
    expect(found).to_be_visible()
    found.click()
    expect(page.page.locator("article mark", has_text="detection limit").first).to_be_visible()


def test_light_and_dark_can_be_chosen_and_stay(helpful: Site) -> None:
    page = helpful.open()
    page.goto("/help/")
    body = page.page.locator("body")
    expect(body).to_have_attribute("data-md-color-scheme", "default")
    page.page.get_by_title("Dark").click()
    expect(body).to_have_attribute("data-md-color-scheme", "slate")
    page.goto("/help/reference/losses.html")
    expect(body).to_have_attribute("data-md-color-scheme", "slate")


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("way", ["", "reference/losses.html", "how-to/notifications.html"])
def test_a_page_is_accessible(helpful: Site, way: str, dark: bool) -> None:
    page = helpful.open(dark=dark)
    page.goto(f"/help/{way}")
    page.require_accessible()


def test_a_page_can_be_read_on_a_phone_and_without_scripts(helpful: Site) -> None:
    page = helpful.open(screen=PHONE, javascript=False)
    page.goto("/help/reference/losses.html")
    expect(page.page.get_by_role("heading", level=1)).to_contain_text("Losses and efficiency")
