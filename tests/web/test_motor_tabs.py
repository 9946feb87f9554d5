"""The tabs of a motor with trouble: short enough to read, and every chart of them to take away."""

import csv
import time
from pathlib import Path

import pytest
from playwright.sync_api import expect

from core.condition.events import Event, EventKind
from service.storage.records import Role
from service.storage.records.alarms import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind
from service.web.motor.page import TABS, tab_address
from testing.web.seeding import BY, FAULTY, RECORDED
from testing.web.site import Site

DESKTOP, PHONE = (1280, 900), (390, 844)
SCREENS = {DESKTOP: 2.0, PHONE: 5.0}
"""So many of them a tab is high at most."""
HEIGHT = "document.documentElement.scrollHeight"
DRAWN = """() => document.documentElement.dataset.ready === "true"
    && [...document.querySelectorAll("figure[data-chart]")].every((one) => one.querySelector("canvas"))"""


def trouble(site: Site) -> None:
    """Give the faulty motor much that people have written, and more than one alarm."""
    repository, now_ns = site.repository, time.time_ns()
    for number in range(30):
        note = Event(now_ns - number * 10**12, EventKind.NOTE, "noise at the drive end " * 8)
        repository.add_event(FAULTY, note, by=BY, now_ns=now_ns)
    for kind in (AlarmKind.ROTOR_FAULT, AlarmKind.CONDITION_WATCH, AlarmKind.SUPPLY_WATCH):
        repository.raise_alarm_at(
            AlarmPlace(motor=FAULTY), AlarmSpec(kind, "told " * 60, kind), now_ns=now_ns
        )


def test_no_tab_is_longer_than_two_screens_or_five_of_a_phone(site: Site) -> None:
    trouble(site)
    long = []
    for screen, most in SCREENS.items():
        page = site.open(Role.ENGINEER, Role.OPERATOR, screen=screen)
        for motor in (FAULTY, RECORDED):
            for tab in TABS:
                page.goto(tab_address(motor, tab))
                page.page.wait_for_function(DRAWN)
                screens = page.page.evaluate(HEIGHT) / screen[1]
                if screens > most:
                    long.append(f"{motor} {tab.words} at {screen}: {screens:.2f} screens of {most}")
                page.require_no_sideways_scroll()
    assert not long, "\n".join(long)


def test_state_headline_and_action_stand_on_the_first_screen(site: Site) -> None:
    trouble(site)
    for screen in SCREENS:
        page = site.open(Role.VIEWER, screen=screen)
        page.goto(f"/motors/{FAULTY}")
        box = page.page.locator("#verdict .advice").bounding_box()
        assert box is not None
        assert box["y"] + box["height"] < screen[1]
    lines = page.page.locator("#parts li")
    expect(lines).to_have_count(6)


@pytest.mark.parametrize("tab", ["", "/rotor", "/supply", "/nameplate"])
def test_every_chart_gives_its_values_and_its_picture(looked_at: Site, tab: str, tmp_path: Path) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto(f"/motors/{FAULTY}{tab}")
    page.page.wait_for_function(DRAWN)
    figures = page.page.locator("figure[data-chart]")
    for number in range(figures.count()):
        figure = figures.nth(number)
        caption = figure.get_attribute("data-chart-name") or ""
        with page.page.expect_download() as values:
            figure.get_by_role("button", name="Values as CSV").click()
        assert values.value.suggested_filename == f"{caption.replace(' ', '-')}.csv"
        values.value.save_as(tmp_path / "values.csv")
        with (tmp_path / "values.csv").open(encoding="utf-8-sig", newline="") as file:
            head, *lines = csv.reader(file)
        assert head[0] == "time (UTC)"
        assert {len(line) for line in lines} == {len(head)}
        with page.page.expect_download() as picture:
            figure.get_by_role("button", name="Picture as PNG").click()
        picture.value.save_as(tmp_path / "picture.png")
        assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")


def test_pictures_are_taken_away_with_the_colours_of_the_page(looked_at: Site, tmp_path: Path) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto(f"/motors/{FAULTY}/stator")
    figures = page.page.locator("figure[data-picture]")
    assert figures.count() == 2
    with page.page.expect_download() as picture:
        figures.first.get_by_role("button", name="Picture as SVG").click()
    picture.value.save_as(tmp_path / "picture.svg")
    text = (tmp_path / "picture.svg").read_text(encoding="utf-8")
    assert "var(" not in text
    assert "asymmetry by phase" in text
    with page.page.expect_download() as values:
        figures.first.get_by_role("button", name="Values as CSV").click()
    values.value.save_as(tmp_path / "values.csv")
    assert (tmp_path / "values.csv").read_text(encoding="utf-8-sig").startswith("record,level,")


def test_charts_share_one_cursor(looked_at: Site) -> None:
    page = looked_at.open(Role.VIEWER)
    page.goto(f"/motors/{FAULTY}?days=30")
    page.page.wait_for_function(DRAWN)
    page.page.locator('[data-chart="trend-data"] [data-chart-place]').focus()
    told = page.page.locator('[data-chart="trend-data"] [data-chart-readout]')
    expect(told).to_contain_text(" · ")
    load = page.page.locator('[data-chart="load-data"] [data-chart-readout]')
    expect(load).to_contain_text(told.inner_text().split(" · ")[0])
