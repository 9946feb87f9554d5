"""Acknowledging alarms: by keyboard alone, and with a session that ends while somebody types."""

import time

import pytest

from service.access.passwords import hashed
from service.storage.records import Role
from service.storage.states import AlarmState
from testing.service.accounts import TESTS
from testing.web.site import PHONE, Screen, Site
from testing.web.watched_page import WatchedPage

COMMENT = "looked at it, winding of phase b"
KNOWN_WORDS = "correct horse battery"
MOST_STEPS = 80


def states(site: Site) -> list[AlarmState]:
    return [alarm.state for alarm in site.repository.alarms(limit=100).items]


def tab_to(page: WatchedPage, words: str, *, role: str) -> None:
    """Press Tab until what has the focus is called so; it can be seen that it has the focus."""
    for _ in range(MOST_STEPS):
        page.page.keyboard.press("Tab")
        here = page.page.locator("*:focus")
        name = here.evaluate(NAME)
        if role == here.evaluate("one => one.tagName.toLowerCase()") and words in name:
            assert here.evaluate(SHOWS_FOCUS), f"nothing shows that {name} has the focus"
            return
    raise AssertionError(f"Tab leads to no {role} {words}")


NAME = """one => one.getAttribute("aria-label") || [...(one.labels || [])].map((l) => l.textContent).join(" ")
    || one.textContent"""
SHOWS_FOCUS = """one => { const style = getComputedStyle(one);
    const outlined = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1;
    return outlined || style.boxShadow !== "none"; }"""


@pytest.mark.parametrize("screen", [(1280, 800), PHONE])
def test_an_alarm_is_acknowledged_by_keyboard_alone(site: Site, screen: Screen) -> None:
    page = site.open(Role.OPERATOR, screen=screen)
    page.goto("/alarms")
    page.page.keyboard.press("Tab")
    assert page.page.locator("*:focus").inner_text() == "Skip to the content"
    page.page.keyboard.press("Enter")
    unacknowledged = states(site).count(AlarmState.UNACKNOWLEDGED)
    tab_to(page, "Comment", role="textarea")
    page.page.keyboard.type(COMMENT)
    tab_to(page, "Acknowledge", role="button")  # that of those chosen
    tab_to(page, "Acknowledge", role="button")  # that of the first alarm
    page.page.keyboard.press("Enter")
    page.page.get_by_text("cknowledged").first.wait_for()
    page.page.wait_for_url("**/alarms?*done=*")
    assert states(site).count(AlarmState.UNACKNOWLEDGED) == unacknowledged - 1
    assert page.page.locator("textarea").first.input_value() == "", "what was sent is no draft any more"


def test_several_alarms_are_acknowledged_at_once_and_the_comment_is_kept_with_each(site: Site) -> None:
    page = site.open(Role.OPERATOR)
    page.goto("/alarms")
    boxes = page.page.locator("input[name=alarm]")
    number = boxes.count()
    assert number >= 2
    for at in range(number):
        boxes.nth(at).check()
    page.page.locator("textarea[name=comment]").fill(COMMENT)
    page.page.get_by_role("button", name="Acknowledge those chosen").click()
    page.page.wait_for_url("**/alarms?*done=*")
    assert AlarmState.UNACKNOWLEDGED not in states(site)
    for alarm in site.repository.alarms(limit=100).items:
        changes = site.repository.alarm_changes(alarm.id, limit=100).items
        assert COMMENT in {change.comment for change in changes}


def test_a_session_that_ends_while_somebody_types_loses_no_word(site: Site) -> None:
    now_ns = time.time_ns()
    site.repository.add_user("kim", [Role.OPERATOR], password=hashed(KNOWN_WORDS), by=TESTS, now_ns=now_ns)
    page = site.open(user="kim")
    page.goto("/alarms")
    page.page.locator("input[name=alarm]").first.check()
    page.page.locator("textarea[name=comment]").fill(COMMENT)
    site.repository.end_sessions_of("kim", by=TESTS, now_ns=now_ns)
    page.accepted.add(401)
    page.page.get_by_role("button", name="Acknowledge those chosen").click()
    login = page.page.locator("#messages a[href^='/login']")
    login.wait_for()
    assert page.path == "/alarms", "the page stays where it is"
    with page.page.expect_response(lambda answer: answer.headers.get("hx-retarget") == "#messages"):
        page.page.evaluate("htmx.ajax('GET', '/alarms', {source: '#alarm-list', select: '#alarm-list'})")
    assert login.is_visible(), "a refresh of a part of the page leaves the words where they are"
    with page.page.context.expect_page() as opened:
        login.evaluate("one => one.click()")  # what is told again meanwhile takes its place
    other = opened.value
    other.get_by_label("Name").fill("kim")
    other.get_by_label("Password").fill(KNOWN_WORDS)
    other.get_by_role("button", name="Log in").click()
    other.wait_for_url("**/alarms*")
    other.close()
    page.page.reload()
    assert page.page.locator("textarea[name=comment]").input_value() == COMMENT
    assert page.page.locator("input[name=alarm]").first.is_checked()
    page.page.get_by_role("button", name="Acknowledge those chosen").click()
    page.page.wait_for_url("**/alarms?*done=*")
    assert page.page.locator("textarea[name=comment]").input_value() == ""
