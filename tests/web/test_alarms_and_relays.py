"""Alarms, relays, people and messages in a real browser: what is typed stays, what is done is seen."""

import re
import time
from pathlib import Path

from playwright.sync_api import Browser, expect

from service.storage.records import Role
from service.storage.states import AlarmKind, AlarmState
from service.timing.backoff import Backoff
from testing.service.accounts import TESTS
from testing.web.followers import until_followed
from testing.web.seeding import seed
from testing.web.site import PHONE, Site, running_site

COMMENT = "half a sentence"


def raise_another(site: Site, subject: str, reason: str = "odd name") -> None:
    relay = site.repository.relays(limit=1).items[0].name
    site.repository.raise_alarm(relay, AlarmKind.FILE_REFUSED, subject, reason, now_ns=time.time_ns())


def test_news_takes_away_neither_what_is_chosen_nor_what_is_typed(site: Site) -> None:
    page = site.open(Role.OPERATOR)
    page.goto("/alarms")
    until_followed(site.app, 1)
    box = page.page.locator("input[name=alarm]").first
    chosen = box.get_attribute("value")
    box.check()
    comment = page.page.locator("textarea[name=comment]")
    comment.press_sequentially(COMMENT)
    raise_another(site, "while somebody types")
    expect(page.page.locator(".alarm", has_text="while somebody types")).to_have_count(1)
    expect(comment).to_be_focused()
    expect(comment).to_have_value(COMMENT)
    expect(page.page.locator(f"input[value='{chosen}']")).to_be_checked()
    assert page.page.locator("input[name=alarm]:checked").count() == 1


def test_times_are_those_of_the_viewers_zone_and_utc_stands_in_their_titles(site: Site) -> None:
    raise_another(site, "HR_00007.CFG", "of 2026-07-01T10:30:05Z, larger than `max_file_bytes`")
    for zone, local in (("Europe/Berlin", "12:30:05"), ("America/New_York", "06:30:05")):
        page = site.open(Role.VIEWER, time_zone=zone)
        page.goto("/alarms")
        alarm = page.page.locator(".alarm", has_text="HR_00007.CFG")
        expect(alarm.locator(".reason")).to_have_text(
            f"HR_00007.CFG: of 2026-07-01 {local}, larger than max_file_bytes"
        )
        zones = re.compile(r"^2026-07-01 \S+ [+-]\d\d:00 \(2026-07-01 10:30:05 UTC\)$")
        expect(alarm.locator(".reason time")).to_have_attribute("title", zones)
        raised = alarm.locator(".when time[title]").last
        assert (raised.get_attribute("title") or "").startswith(raised.inner_text())


def test_one_alarm_is_shelved_and_its_end_is_told_to_another_viewer(site: Site) -> None:
    alarm = site.repository.open_alarms(limit=1).items[0]
    other = site.open(Role.VIEWER, screen=PHONE)
    other.goto(f"/alarms/{alarm.id}")
    page = site.open(Role.OPERATOR)
    page.goto(f"/alarms/{alarm.id}")
    until_followed(site.app, 2)
    page.page.get_by_label("Comment").fill("spare part on Friday")
    page.page.locator("select[name=hours]").select_option("72")
    page.page.get_by_role("button", name="Shelve").click()
    expect(page.page.locator("#messages")).to_contain_text("The alarm is shelved.")
    expect(page.page.get_by_role("button", name="End the shelving")).to_have_count(1)
    for one in (page, other):
        expect(one.page.locator("#alarm")).to_contain_text("shelved until")
        expect(one.page.locator("#alarm-history")).to_contain_text("spare part on Friday")
    assert other.page.locator("main form").count() == 0, "who only looks is offered nothing to do"
    page.goto("/alarms?show=set-aside")
    expect(page.page.locator(".alarm")).to_contain_text(["spare part on Friday"])


def test_what_can_be_done_follows_what_others_do(site: Site) -> None:
    alarm = next(
        one for one in site.repository.open_alarms(limit=50).items if one.state is AlarmState.UNACKNOWLEDGED
    )
    page = site.open(Role.OPERATOR)
    page.goto(f"/alarms/{alarm.id}")
    until_followed(site.app, 1)
    page.page.get_by_label("Comment").press_sequentially(COMMENT)
    site.repository.acknowledge_alarm(alarm.id, by=TESTS, now_ns=time.time_ns(), comment="first")
    expect(page.page.get_by_role("button", name="Acknowledge")).to_have_count(0)
    expect(page.page.locator("#alarm")).to_contain_text(f"acknowledged by {TESTS.name}")
    expect(page.page.get_by_label("Comment")).to_have_value(COMMENT)


def test_a_relay_set_aside_is_released(site: Site) -> None:
    relay = site.repository.relays(limit=1).items[0].name
    page = site.open(Role.OPERATOR, screen=PHONE)
    page.goto("/relays")
    until_followed(site.app, 1)
    backoff = Backoff(600.0, 600.0)
    site.repository.set_aside(relay, "crashed a gateway", backoff=backoff, now_ns=time.time_ns())
    card = page.page.locator("tr", has_text=relay)
    expect(card).to_contain_text("quarantined")
    expect(card).to_contain_text("crashed a gateway")
    card.get_by_role("link", name=relay).click()
    page.page.get_by_role("button", name=f"Release {relay}").click()
    expect(page.page.locator("#messages")).to_contain_text("The relay is released")
    expect(page.page.locator("#relay .state").first).to_contain_text("unknown")
    assert site.repository.quarantine(relay) is None


def test_a_user_is_added_and_an_own_token_is_shown_once(site: Site) -> None:
    page = site.open(Role.SECADM)
    page.goto("/people")
    page.page.get_by_label("Name", exact=True).fill("kim")
    page.page.get_by_label("VIEWER").check()
    page.page.get_by_role("button", name="Add the user").click()
    page.page.wait_for_url("**/people/kim?done=user-added")
    page.goto("/account")
    page.page.get_by_text("Make a token").click()
    page.page.get_by_label("For what").fill("historian")
    page.page.get_by_role("button", name="Make the token").click()
    secret = page.page.locator("#secret").inner_text()
    assert len(secret) > 20
    page.page.get_by_role("link", name="I have copied it").click()
    expect(page.page.locator("#tokens ~ table")).to_contain_text("historian")
    assert secret not in page.page.content()


def test_a_wrong_name_is_told_in_place_and_what_was_typed_stays(site: Site) -> None:
    page = site.open(Role.SECADM)
    page.goto("/people")
    page.accepted.add(422)
    page.page.get_by_label("Name", exact=True).fill("no such/name")
    page.page.get_by_label("Full name").fill("Kim K.")
    page.page.get_by_role("button", name="Add the user").click()
    expect(page.page.locator("#messages")).to_contain_text("1 to 100 letters")
    expect(page.page.get_by_label("Full name")).to_have_value("Kim K.")
    page.problems = [one for one in page.problems if "Error Code 422" not in one]


def test_a_test_message_is_queued_by_its_button(tmp_path: Path, browser: Browser) -> None:
    seed(tmp_path)
    mail = {
        "kind": "mail",
        "host": "mail.plant.example",
        "from": "mcc@plant.example",
        "to": ["a@plant.example"],
    }
    with running_site(tmp_path, browser, notifications={"channels": {"ops": mail}}) as site:
        page = site.open(Role.ENGINEER)
        page.goto("/notifications")
        page.page.get_by_role("button", name="Send a test through ops").click()
        expect(page.page.locator("#messages")).to_contain_text("A test is on its way")
        expect(page.page.locator("section", has_text="What was sent to whom")).to_contain_text(
            "a@plant.example"
        )
        page.require_quiet()
