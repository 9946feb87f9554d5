"""Two who look at the same page see what one of them, or a relay, has changed."""

import time
from collections.abc import Callable

from playwright.sync_api import APIResponse, Route, expect

from service.storage.records import Role
from service.storage.states import AlarmKind, LinkState
from testing.service.links import set_link_state
from testing.waiting import wait_until
from testing.web.followers import until_followed
from testing.web.seeding import FAULTY, acknowledge_all
from testing.web.site import Site
from testing.web.watched_page import WatchedPage

LIMIT_S = 2.0


def within_limit(page: WatchedPage, script: str, argument: object, since_s: float) -> float:
    """Wait until a script of the page returns what is true; return after how long [s]."""
    page.page.wait_for_function(script, arg=argument, polling=50)
    return time.monotonic() - since_s


HAS_TEXT = "(words) => document.querySelector('main').textContent.includes(words)"


def seen_by_two(site: Site, path: str, change: Callable[[], object], words: str) -> list[float]:
    """Have something change while two look; return after how long each of them saw it."""
    viewers = [site.open(Role.OPERATOR), site.open(Role.VIEWER)]
    for viewer in viewers:
        viewer.goto(path)
        viewer.page.wait_for_function("() => document.documentElement.dataset.ready === 'true'")
    assert all(words not in viewer.page.locator("main").inner_text() for viewer in viewers)
    change()
    since_s = time.monotonic()
    return [within_limit(viewer, HAS_TEXT, words, since_s) for viewer in viewers]


def test_a_new_alarm_is_seen_by_two_within_two_seconds(site: Site) -> None:
    def refuse() -> None:
        relay = site.repository.relays(limit=1).items[0].name
        site.repository.raise_alarm(
            relay, AlarmKind.FILE_REFUSED, "HR_00099.CFG", "too short", now_ns=time.time_ns()
        )

    after_s = seen_by_two(site, "/alarms", refuse, "HR_00099.CFG")
    assert max(after_s) <= LIMIT_S


def test_what_one_acknowledges_the_other_sees_within_two_seconds(site: Site) -> None:
    one, other = site.open(Role.OPERATOR), site.open(Role.OPERATOR)
    for viewer in (one, other):
        viewer.goto("/alarms")
    number = other.page.get_by_role("button", name="Acknowledge ").count()
    one.page.locator("button[name=only]").first.click()
    one.page.wait_for_url("**/alarms?*done=*")
    since_s = time.monotonic()
    fewer = "(number) => document.querySelectorAll('button[name=only]').length < number"
    other.page.wait_for_function(fewer, arg=number, polling=50)
    assert time.monotonic() - since_s <= LIMIT_S


def hold_the_first_answer(page: WatchedPage, event: str) -> list[tuple[Route, APIResponse]]:
    """Keep the answer to the first refresh of a page, and count what the page is told."""
    held: list[tuple[Route, APIResponse]] = []

    def hold(route: Route) -> None:
        if held or "x-refresh" not in route.request.headers:
            route.continue_()
        else:
            held.append((route, route.fetch()))

    page.page.route(page.page.url, hold)
    page.page.evaluate(
        "event => { window.told = 0; document.addEventListener(event, () => { window.told += 1; }); }", event
    )
    return held


def test_what_changes_while_a_part_is_asked_for_is_seen_too(site: Site) -> None:
    def refuse(file: str) -> None:
        relay = site.repository.relays(limit=1).items[0].name
        now_ns = time.time_ns()
        site.repository.raise_alarm(relay, AlarmKind.FILE_REFUSED, file, "too short", now_ns=now_ns)

    page = site.open(Role.VIEWER)
    page.goto("/alarms")
    until_followed(site.app, 1)
    held = hold_the_first_answer(page, "sse:alarms")
    refuse("HR_00001.CFG")
    page.page.wait_for_function("() => window.told >= 1")
    wait_until(lambda: page.page.evaluate("() => true") and held, "an answer")
    refuse("HR_00002.CFG")
    page.page.wait_for_function("() => window.told >= 2")
    route, answer = held[0]
    route.fulfill(response=answer)
    expect(page.page.locator("main")).to_contain_text("HR_00002.CFG")


def test_what_changes_while_the_fleet_is_asked_for_is_seen_too(site: Site) -> None:
    page = site.open(Role.VIEWER)
    page.goto("/")
    until_followed(site.app, 1)
    calls = page.page.locator("tr", has_text=FAULTY).locator(".calls")
    expect(calls).to_have_count(1)
    held = hold_the_first_answer(page, "sse:fleet")
    relay = site.repository.relays(limit=1).items[0].name
    set_link_state(site.repository, relay, LinkState.DOWN, "gone", now_ns=time.time_ns())
    page.page.wait_for_function("() => window.told >= 1")
    wait_until(lambda: page.page.evaluate("() => true") and held, "an answer")
    acknowledge_all(site.repository, FAULTY)
    page.page.wait_for_function("() => window.told >= 2")
    route, answer = held[0]
    route.fulfill(response=answer)
    expect(calls).to_have_count(0)
