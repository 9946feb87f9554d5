"""The page of a motor in a real browser: looking closer at its trend by keys, and what follows by itself."""

import re
import time
from dataclasses import replace

from playwright.sync_api import expect

from service.storage.records import Role
from testing.service.conditions import FAULT, fold, tell, told_event
from testing.web.seeding import FAULTY, RECORDED, WELL
from testing.web.site import PHONE, Site

TREND = '[data-chart="trend-data"]'


def test_whoever_looks_closer_by_keys_gets_the_records_of_that_time(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto(f"/motors/{FAULTY}?days=all")
    place = page.page.locator(f"{TREND} [data-chart-place]")
    readout = page.page.locator(f"{TREND} [data-chart-readout]")
    place.focus()
    expect(readout).to_contain_text("level")
    before = readout.inner_text()
    place.press("ArrowRight")
    expect(readout).not_to_have_text(before)
    with page.page.expect_response(lambda answer: "/trend?from_s=" in answer.url) as closer:
        place.press("+")
    assert closer.value.ok
    labels = [one["label"] for one in closer.value.json()["series"]]
    assert labels[:2] == ["95 % interval", "level"]
    place.press("0")
    place.press("End")
    expect(readout).to_contain_text("fault")


def test_the_page_follows_a_new_record_and_leaves_open_what_was_opened(site: Site) -> None:
    page = site.open(Role.VIEWER)
    page.goto(f"/motors/{WELL}")
    expect(page.page.locator("#verdict .sentence")).to_contain_text("No change is seen")
    page.page.locator("#why summary").click()
    now_ns = time.time_ns()
    tell(site.repository, replace(FAULT, motor=WELL, as_of_ns=now_ns), now_ns=now_ns)
    expect(page.page.locator("#verdict .sentence")).to_contain_text("Shorted turns in phase b")
    expect(page.page.locator("#why")).to_have_attribute("open", "")


def test_a_new_record_asks_for_the_page_once(site: Site) -> None:
    now_ns = time.time_ns()
    event_id = told_event(site.repository, WELL, now_ns=now_ns)
    page = site.open(Role.VIEWER)
    page.goto(f"/motors/{WELL}")
    asked: list[str] = []
    page.page.on("request", lambda request: asked.append(request.url))
    fold(site.repository, replace(FAULT, motor=WELL, as_of_ns=now_ns), event_id, now_ns=now_ns)
    expect(page.page.locator("#verdict .sentence")).to_contain_text("Shorted turns in phase b")
    expect(page.page.locator("#stator")).to_contain_text("fault")
    followed = [one for one in asked if "/motors/" in one]
    # Alarms of the same change are a subject of their own.
    assert len(followed) <= 2, followed


def test_a_note_that_was_not_sent_is_still_there_after_a_reload(site: Site) -> None:
    page = site.open(Role.OPERATOR)
    page.goto(f"/motors/{FAULTY}/logbook")
    page.page.get_by_text("Write a note", exact=True).click()
    page.page.get_by_label("What happened").fill("noise at the drive end")
    page.page.reload()
    page.page.get_by_text("Write a note", exact=True).click()
    expect(page.page.get_by_label("What happened")).to_have_value("noise at the drive end")
    page.page.get_by_role("button", name="Save note").click()
    expect(page.page.locator("#logbook .notes")).to_contain_text("noise at the drive end")
    assert page.path == f"/motors/{FAULTY}/logbook?done=note-kept"


def test_on_a_phone_sentence_alarm_and_trend_come_first(looked_at: Site) -> None:
    page = looked_at.open(Role.OPERATOR, screen=PHONE)
    page.goto(f"/motors/{FAULTY}")
    tops = [page.page.locator(one).bounding_box() for one in ("#verdict", "#parts", "#alarms", "#trend")]
    found = [box["y"] for box in tops if box is not None]
    assert len(found) == 4
    assert found == sorted(found)
    page.require_no_sideways_scroll()


def test_starts_are_pictures_with_words(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto(f"/motors/{RECORDED}")
    page.page.get_by_role("navigation", name=RECORDED).get_by_role("link", name="Starts").click()
    expect(page.page.get_by_role("img", name="current of recorded starts")).to_be_visible()
    expect(page.page.locator("tbody tr")).to_contain_text("reference")


def test_a_note_is_kept_while_it_is_typed_and_its_time_is_that_of_the_viewer(site: Site) -> None:
    page = site.open(Role.ENGINEER, Role.OPERATOR)
    page.goto(f"/motors/{WELL}/logbook")
    form = page.page.locator("form[action$='/notes']")
    page.page.locator("#logbook details:has(form[action$='/notes'])").evaluate("one => { one.open = true }")
    expect(form).to_contain_text("When, in your time, Europe/Berlin")
    form.locator("[name=text]").fill("terminals cleaned")
    form.locator("[name=kind]").select_option("maintenance")
    form.locator("[name=anew]").check()
    form.locator("[name=time]").fill("2026-07-01T12:30")
    page.page.reload()
    expect(form.locator("[name=kind]")).to_have_value("maintenance")
    expect(form.locator("[name=anew]")).to_be_checked()
    page.page.locator("#logbook details:has(form[action$='/notes'])").evaluate("one => { one.open = true }")
    form.get_by_role("button").click()
    page.page.wait_for_url("**done=note-kept")
    kept = page.page.locator("#logbook .notes li").filter(has_text="terminals cleaned")
    expect(kept.locator("time").first).to_have_attribute(
        "title", "2026-07-01 12:30 +02:00 (2026-07-01 10:30 UTC)"
    )
    expect(form.locator("[name=text]")).to_have_value("")


def test_rotor_and_supply_are_told_and_drawn(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    for tab, told, key, value in (
        ("rotor", "The cage is even", "rotor-severity", "-68"),
        ("supply", "derating 1.00", "supply", "0.68"),
    ):
        page.goto(f"/motors/{FAULTY}/{tab}")
        expect(page.page.locator(f"#{tab}")).to_contain_text(told)
        chart = page.page.locator(f'[data-chart="{key}-data"]')
        expect(chart.locator("[data-chart-tools] button").first).to_be_visible()  # it is drawn
        chart.locator("[data-chart-place]").focus()
        chart.locator("[data-chart-place]").press("End")
        expect(chart.locator("[data-chart-readout]")).to_contain_text(value)


def test_charts_and_text_write_times_alike(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto(f"/motors/{FAULTY}?days=all")
    text = page.page.locator("main time:not([data-age])").first
    expect(text).to_have_text(re.compile(r"^\d{4}-\d\d-\d\d \d\d:\d\d(:\d\d)?$"))
    expect(text).to_have_attribute("title", re.compile(r" (UTC|[+-]\d\d:\d\d) \(.* UTC\)$"))
    page.page.locator(f"{TREND} [data-chart-place]").focus()
    readout = page.page.locator(f"{TREND} [data-chart-readout]")
    expect(readout).to_contain_text(re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d · "))
