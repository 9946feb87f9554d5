"""Two who look at the same page see what one of them, or a relay, has changed."""

import time
from collections.abc import Callable

from service.storage.records import Role
from service.storage.states import AlarmKind
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
