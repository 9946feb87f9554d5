"""The fleet in a real browser: found at a glance, filtered, and live."""

import re
import time

from playwright.sync_api import expect

from service.storage.records import Actor, Role
from testing.web.followers import until_followed
from testing.web.seeding import FAULTY, STALE, STANDING, WATCHED, WELL, acknowledge_all
from testing.web.site import PHONE, Site
from testing.web.watched_page import WatchedPage

BY = Actor("ann", "127.0.0.1")


LOOKED_AT = """() => {{
    Object.defineProperty(document, "hidden", {{ value: {}, configurable: true }});
    document.dispatchEvent(new Event("visibilitychange"));
}}"""


TOP_OF_WORDS = """links => links.map((link) => {
    const words = document.createRange();
    words.selectNodeContents(link.lastChild);
    return words.getBoundingClientRect().top;
})"""


def motors_of(page: WatchedPage) -> list[str]:
    return page.page.locator("table.fleet th[scope=row] > a:first-child").all_inner_texts()


def test_the_worst_motor_comes_first_with_what_to_do(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/")
    assert motors_of(page)[0] == FAULTY
    expect(page.page.locator("#summary")).to_contain_text(f"{FAULTY} needs attention first")
    first = page.page.locator("table.fleet tbody tr").first
    for words in ("fault", "phase", "since", "Stop the motor at the next opportunity", "ago"):
        expect(first).to_contain_text(words)
    expect(page.page.locator("tr", has_text=STALE)).to_contain_text("no recent record")
    expect(page.page.locator("tr", has_text=STALE)).to_contain_text("link down: ")
    expect(page.page.locator("tr", has_text=STANDING)).to_contain_text("not running")


def test_on_a_phone_the_motors_are_cards(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER, screen=PHONE)
    page.goto("/")
    page.require_no_sideways_scroll()
    card = page.page.locator("table.fleet tbody tr").first
    assert card.evaluate("element => getComputedStyle(element).display") == "grid"
    expect(card).to_contain_text(FAULTY)
    box = page.page.locator("#summary .advice").bounding_box()
    assert box is not None
    assert box["y"] + box["height"] < PHONE[1], "which motor and what to do is told before anybody scrolls"
    verdict = page.page.locator("#summary .verdict")
    for words in (FAULTY, "phase", "since", "level", "Latest record"):
        expect(verdict).to_contain_text(words)


def test_the_counts_stand_on_one_line(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/")
    tops = page.page.locator("#summary .counts a").evaluate_all(TOP_OF_WORDS)
    assert len(tops) > 2
    assert max(tops) - min(tops) < 1.0


def test_filters_are_in_the_address_and_survive_a_reload(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/")
    page.page.get_by_label("Text").press_sequentially("ball MILL")
    expect(page.page.locator("table.fleet tbody tr")).to_have_count(1)
    page.page.wait_for_url(re.compile("text=ball"))
    page.page.reload()
    assert motors_of(page) == [WATCHED]
    page.page.get_by_label("Text").fill("")
    page.page.get_by_role("combobox", name="State").select_option("healthy")
    expect(page.page.locator("table.fleet tbody")).to_contain_text(WELL)
    expect(page.page.locator("table.fleet tbody tr")).to_have_count(1)
    assert motors_of(page) == [WELL]
    page.page.get_by_role("link", name="1 not running").click()
    expect(page.page.locator("table.fleet tbody")).to_contain_text(STANDING)
    assert motors_of(page) == [STANDING]
    page.page.go_back()
    expect(page.page.locator("table.fleet tbody")).to_contain_text(WELL)
    assert motors_of(page) == [WELL]
    page.page.get_by_role("combobox", name="State").select_option("")
    page.page.get_by_role("combobox", name="Site").select_option("FACTORY_B")
    page.page.wait_for_url(re.compile("site=FACTORY_B"))
    expect(page.page.locator("table.fleet caption")).to_contain_text("3 of 6 motors")
    assert FAULTY not in motors_of(page)


def test_motors_stand_under_their_sites_and_parts_that_are_not_assessed_are_counted(
    looked_at: Site,
) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto("/")
    page.page.get_by_label("Group by site").check()
    headings = page.page.locator("table.fleet tr.site")
    expect(headings).to_have_count(2)
    expect(headings.first).to_contain_text("FACTORY_A 3 motors, 1 fault, 2 watch")
    page.page.wait_for_url(re.compile("group=site"))
    silent = page.page.locator("#silent")
    parts = int(silent.locator("summary").inner_text().split()[0])
    silent.locator("summary").click()
    rows = silent.locator("li").all_inner_texts()
    assert parts == sum(int(row.split(": ")[1].split()[0]) for row in rows)
    rotor = next(row for row in rows if row.startswith("Rotor"))
    silent.get_by_role("link", name="Rotor").click()
    page.page.wait_for_url(re.compile("not_assessed=rotor"))
    assert f": {len(motors_of(page))} motors" in rotor


def test_a_wall_screen_has_all_motors_and_follows_by_itself(site: Site) -> None:
    page = site.open(Role.VIEWER, screen=(1920, 1080))
    page.goto("/wall")
    tiles = page.page.locator(".tile > a")
    assert tiles.all_inner_texts()[0] == FAULTY
    assert tiles.count() == 6
    assert page.page.locator("header, nav, form").count() == 0
    assert page.page.evaluate("document.documentElement.scrollHeight <= innerHeight")
    until_followed(site.app, 1)
    acknowledge_all(site.repository, FAULTY)
    expect(tiles.first).to_have_text(WATCHED)


def test_without_scripts_everything_can_be_read_and_filtered(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER, javascript=False)
    page.goto("/")
    assert len(motors_of(page)) == 6
    page.page.get_by_role("combobox", name="State").select_option("stale")
    page.page.get_by_role("button", name="Show").click()
    assert motors_of(page) == [STALE]
    assert "UTC" in (page.page.locator("table.fleet time").first.get_attribute("title") or "")


def test_two_viewers_see_a_change_within_two_seconds(site: Site) -> None:
    pages = [site.open(Role.VIEWER), site.open(Role.OPERATOR, screen=PHONE)]
    for page in pages:
        page.goto("/")
        expect(page.page.locator("tr", has_text=FAULTY).locator(".calls")).to_have_count(1)
    until_followed(site.app, 2)
    pages[0].page.locator("tr", has_text=WELL).get_by_role("link", name=WELL).focus()
    kept = pages[0].page.locator("tr", has_text=WELL).element_handle()
    began = time.monotonic()
    acknowledge_all(site.repository, FAULTY)
    for page in pages:
        expect(page.page.locator("tr", has_text=FAULTY).locator(".calls")).to_have_count(0)
    assert time.monotonic() - began < 2.0
    assert motors_of(pages[0])[0] == WATCHED, "it has an alarm that nobody has acknowledged"
    assert kept.evaluate("row => row.isConnected && row.contains(document.activeElement)"), "the focus stays"


def test_a_page_that_nobody_looks_at_gives_its_connection_back(site: Site) -> None:
    page = site.open(Role.VIEWER)
    page.goto("/")
    until_followed(site.app, 1)
    page.page.evaluate(LOOKED_AT.format("true"))
    until_followed(site.app, 0)
    acknowledge_all(site.repository, FAULTY)
    page.page.evaluate(LOOKED_AT.format("false"))
    expect(page.page.locator("tr", has_text=FAULTY).locator(".calls")).to_have_count(0)


def test_a_session_that_ends_is_told(site: Site) -> None:
    page = site.open(Role.VIEWER)
    page.goto("/")
    until_followed(site.app, 1)
    page.accepted.add(401)
    site.repository.end_sessions_of("viewer", by=BY, now_ns=time.time_ns())
    expect(page.page.locator("#messages")).to_contain_text("log in", ignore_case=True)
    until_followed(site.app, 0)
    page.problems = [one for one in page.problems if "Error Code 401" not in one]
