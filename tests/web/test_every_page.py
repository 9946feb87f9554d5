"""What holds for every page: it works, for everybody, in light and dark, small and large, without scripts."""

import re

import pytest

from service.access.permissions import permissions_of
from service.storage.records import Role
from testing.service.accounts import EVERYTHING
from testing.web.pages import address_of, is_page, page_routes, permission_for, roles_for, routes
from testing.web.site import DESKTOP, PHONE, Site

ENLARGED = (640, 400)
"""A desktop's window at 200 %, in its own pixels."""

TIME = r"\d{4}-\d\d-\d\d \d\d:\d\d( UTC)?"

each_page = pytest.mark.parametrize("route", page_routes())


def path_of(site: Site, route: str) -> str | None:
    """An address of a page; None where the route answers with something else."""
    path = address_of(route, site.repository)
    assert path is not None, f"the seeded plant has nothing for {route}"
    return path if is_page(site.url, path, site.log_in(*roles_for(path))) else None


@each_page
def test_a_page_is_accessible_in_every_light_and_size(looked_at: Site, route: str) -> None:
    path = path_of(looked_at, route)
    if path is None:
        return
    page = looked_at.open(*roles_for(path))
    page.goto(path)
    assert page.page.title().endswith("StatorWatch")
    assert page.page.locator("h1").count() == 1
    page.require_accessible()
    page.require_series_told_apart_without_colours()
    page.page.emulate_media(color_scheme="dark")
    page.require_accessible()
    for width, height in (ENLARGED, PHONE):
        page.page.set_viewport_size({"width": width, "height": height})
        page.require_no_sideways_scroll()
    page.require_accessible()


@each_page
def test_tab_begins_at_the_first_link_and_the_menu_names_the_current_page(
    looked_at: Site, route: str
) -> None:
    path = path_of(looked_at, route)
    if path is None:
        return
    page = looked_at.open(*roles_for(path), screen=PHONE)
    page.goto(path)
    current = page.page.locator("header nav [aria-current]")
    if current.count():
        menu = page.page.locator("header .menu")
        assert menu.inner_text() == f"☰ Menu: {current.text_content()}"
    page.page.keyboard.press("Tab")
    first = page.page.locator("a, button, input:not([type=hidden])").first
    assert first.evaluate("one => one === document.activeElement"), (
        f"{path}: Tab leaves out {first.inner_text()}"
    )


def test_all_pages_are_reached_on_a_phone_without_scripts(looked_at: Site) -> None:
    page = looked_at.open(*EVERYTHING, screen=PHONE, javascript=False)
    page.goto("/")
    links = page.page.locator("header nav a")
    reached = {}
    for number in range(links.count()):
        page.page.get_by_role("button", name="Menu").click()
        link = links.nth(number)
        reached[link.inner_text()] = True
        link.click()
        page.page.wait_for_load_state()
        for other in page.page.locator("nav[aria-label=Settings] a").all():
            assert other.is_visible()
            reached[other.inner_text()] = True
    expected = {"Fleet", "Alarms", "Recordings", "Relays", "Reports", "Settings", "Help", "Plant"}
    assert reached.keys() >= expected | {"Notifications", "People", "Account"}


def test_a_slash_leads_to_the_search_and_the_search_to_the_motor(looked_at: Site) -> None:
    for screen in (DESKTOP, PHONE):
        page = looked_at.open(Role.VIEWER, screen=screen)
        page.goto("/reports")
        page.page.keyboard.press("/")
        page.page.keyboard.type("ball mill")
        page.page.keyboard.press("Enter")
        page.page.wait_for_url("**/motors/MILL-A3")
        page.page.keyboard.press("/")
        page.page.keyboard.type("sel710")
        page.page.keyboard.press("Enter")
        found = page.page.locator("main").get_by_role("link", name="B2_SEL710")
        found.click()
        page.page.wait_for_url("**/relays/B2_SEL710")


@each_page
def test_a_page_can_be_read_without_scripts(looked_at: Site, route: str) -> None:
    path = path_of(looked_at, route)
    if path is None:
        return
    without, with_scripts = (
        looked_at.open(*roles_for(path), javascript=False),
        looked_at.open(*roles_for(path)),
    )
    for page in (without, with_scripts):
        page.goto(path)
    for part in ("h1", "h2", "th", "label"):
        # What a worker draws comes after the page; without scripts it is a link away (test_recording.py).
        # A script asks for times in the zone of who looks, and its label says so.
        seen = f"main {part}:not(#model *):not(:has([data-zone]))"
        texts = [page.page.locator(seen).all_inner_texts() for page in (without, with_scripts)]
        # Scripts write times in the zone of who looks.
        found = [{re.sub(TIME, "", text) for text in one} for one in texts]
        assert found[0] == found[1], part


def test_nothing_moves_where_the_system_asks_for_that(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/")
    page.page.emulate_media(reduced_motion="no-preference")
    assert page.page.evaluate(MOVES), "this is how motion is seen"
    page.page.emulate_media(reduced_motion="reduce")
    assert not page.page.evaluate(MOVES)


MOVES = """() => {
    const one = document.querySelector("h1");
    one.style.transition = "opacity 9s";
    one.getBoundingClientRect();
    one.style.opacity = one.style.opacity === "0.5" ? "1" : "0.5";
    one.getBoundingClientRect();
    return document.getAnimations().length > 0;
}"""


@pytest.mark.parametrize("role", list(Role))
def test_each_role_sees_its_pages_and_buttons_that_it_may_press(looked_at: Site, role: Role) -> None:
    may = permissions_of([role])
    page = looked_at.open(role)
    for route, permission in routes().items():
        path = address_of(route, looked_at.repository)
        if path is None or not is_page_of(looked_at, path):
            continue
        if permission is not None and permission not in may:
            with page.accepting(403):
                answer = page.goto(path)
                assert answer.status == 403 or page.path != path
            continue
        page.goto(path)
        for method, action in page.page.evaluate(FORMS):
            needed = permission_for(method, action)
            assert needed is None or needed in may, f"{role} sees on {path} what needs {needed}: {action}"
        for link in set(page.page.evaluate(LINKS)) - {"/"}:  # it leads each to their own first page
            needed = permission_for("GET", link)
            assert needed is None or needed in may, (
                f"{role} is led from {path} to what needs {needed}: {link}"
            )


FORMS = """() => [...document.querySelectorAll("form")].flatMap((form) =>
    [...form.elements].filter((one) => one.type === "submit").map((one) => [
        (one.getAttribute("formmethod") || form.getAttribute("method") || "get").toUpperCase(),
        new URL(one.getAttribute("formaction") || form.getAttribute("action") || location.href,
            location.href).pathname]))
    .concat([...document.querySelectorAll("[hx-post]")].map((one) => [
        "POST", new URL(one.getAttribute("hx-post"), location.href).pathname]))"""
LINKS = """() => [...document.querySelectorAll("a[href]")].map((one) => new URL(one.href))
    .filter((url) => url.origin === location.origin && !url.pathname.startsWith("/api/")
        && !url.pathname.startsWith("/static/")
        && !url.pathname.startsWith("/help/")).map((url) => url.pathname)"""


def is_page_of(site: Site, path: str) -> bool:
    return is_page(site.url, path, site.log_in(*roles_for(path)))
