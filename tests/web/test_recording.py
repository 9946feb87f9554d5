"""The page of a recording in a browser: zoom to the sample, keys, markers, the model, files dropped."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, Route, expect

from service.storage.records import Role
from service.storage.repository import Repository
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault
from testing.service.database import make_database
from testing.service.job_runner import register_runner
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from testing.service.real_recordings import add_recording, running_record
from testing.service.small_record import CFG, DAT
from testing.waiting import wait_until
from testing.web.site import PHONE, Site, running_site

HOUR_NS = 3600 * SECOND_NS
LONG = "60,000 samples of six channels"


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[tuple[Site, list[str]]]:
    """A site with a healthy recording, one with shorted turns, and one of 60,000 samples of six channels."""
    data = tmp_path_factory.mktemp("recorded")
    make_database(data)
    with running_site(data, browser, motors={"PUMP-A1": REFERENCE}) as site:
        repository: Repository = site.repository
        repository.sync_plant(two_motor_plant())
        register_runner(repository)
        records = [
            running_record(),
            running_record(begin_ns=NOW_NS + HOUR_NS, fault=Fault(0.05, 1)),
            running_record(begin_ns=NOW_NS + 2 * HOUR_NS, seconds=6.0, sample_rate_hz=10_000.0),
        ]
        ids = [add_recording(repository, site.context.store, one) for one in records]
        yield site, ids


@pytest.fixture
def quiet(recorded: tuple[Site, list[str]]) -> Iterator[tuple[Site, list[str]]]:
    """That site; nothing may have gone wrong in its pages."""
    yield recorded
    problems = recorded[0].close_pages()
    assert not problems, "\n".join(problems)


def chart(page: Page, name: str) -> str:
    """Return the selector of a chart."""
    return f"figure[data-chart='{name}-data']"


def readout(page: Page, name: str) -> str:
    return page.locator(f"{chart(page, name)} [data-chart-readout]").inner_text()


def press(page: Page, name: str, *keys: str) -> None:
    """Press keys on a chart."""
    page.locator(f"{chart(page, name)} [data-chart-place]").focus()
    for key in keys:
        page.keyboard.press(key)


def instant(text: str) -> float:
    """Return the time of a readout [s]."""
    return float(text.split(" s ")[0].removeprefix("time "))


def test_one_zooms_to_single_samples_and_sees_the_model_over_them(quiet: tuple[Site, list[str]]) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER)
    page.goto(f"/recordings/{ids[1]}")
    page.page.wait_for_selector(chart(page.page, "residual"))
    press(page.page, "currents", *["+"] * 5)
    legend = page.page.locator(f"{chart(page.page, 'currents')} .chart-legend")
    expect(legend).to_contain_text("model b")
    # What is read at the cursor is the sample itself, and the model's current beside it.
    text = readout(page.page, "currents")
    at = round(instant(text) * 4000.0)
    measured = [float(text.split(f"I{phase} ")[1].split(" A")[0]) for phase in "ABC"]
    record = running_record(begin_ns=NOW_NS + HOUR_NS, fault=Fault(0.05, 1))
    np.testing.assert_allclose(measured, record.samples[:3, at], atol=0.01)
    modelled = [float(text.split(f"model {phase} ")[1].split(" A")[0]) for phase in "abc"]
    np.testing.assert_allclose(modelled, measured, atol=0.1)
    left = readout(page.page, "residual")
    residual = [float(left.split(f"residual {phase} ")[1].split(" A")[0]) for phase in "abc"]
    np.testing.assert_allclose(residual, np.array(measured) - modelled, atol=0.002)
    press(page.page, "currents", "0")
    expect(legend).not_to_contain_text("model b")


def test_arrows_move_the_cursor_of_all_charts_and_the_phasors(quiet: tuple[Site, list[str]]) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER)
    page.goto(f"/recordings/{ids[1]}")
    press(page.page, "voltages", "ArrowRight")
    first = instant(readout(page.page, "voltages"))
    assert instant(readout(page.page, "currents")) == first
    press(page.page, "voltages", "Shift+ArrowRight")
    second = instant(readout(page.page, "voltages"))
    assert second > first
    assert instant(readout(page.page, "states")) == pytest.approx(second)
    told = page.page.locator(".phasor-figures strong")
    wait_until(lambda: abs(float(told.inner_text().removesuffix(" s")) - second) < 0.001)
    press(page.page, "voltages", "Home")
    assert instant(readout(page.page, "voltages")) == 0.0
    assert "50P1 0" in readout(page.page, "states")


def test_the_phasors_are_those_of_the_cursor_also_where_an_answer_comes_late(
    quiet: tuple[Site, list[str]],
) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER)
    page.goto(f"/recordings/{ids[1]}")
    asked: list[Route] = []
    page.page.route("**/phasors?*", lambda route: asked.append(route), times=1)
    with page.page.expect_request("**/phasors?*"):
        press(page.page, "voltages", "ArrowRight")
    looked_at = page.page.locator("[data-cursor-time]")
    first = looked_at.input_value()
    press(page.page, "voltages", "Shift+ArrowRight")
    expect(looked_at).not_to_have_value(first)
    asked[0].continue_()
    told = page.page.locator(".phasor-figures strong")
    second = float(looked_at.input_value())
    wait_until(lambda: abs(float(told.inner_text().removesuffix(" s")) - second) < 0.001)


def test_two_markers_tell_what_differs_between_them(quiet: tuple[Site, list[str]]) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER)
    page.goto(f"/recordings/{ids[0]}")
    press(page.page, "currents", "1", "ArrowRight", "ArrowRight", "2")
    table = page.page.locator("[data-marker-table] table")
    expect(table).to_contain_text("VA (V)")
    cells = table.locator("tbody tr").first.locator("th, td").all_inner_texts()
    assert float(cells[3]) == pytest.approx(float(cells[2]) - float(cells[1]), abs=1e-5)
    assert float(cells[3]) > 0.0
    page.page.get_by_role("button", name="No markers").click()
    expect(table).to_have_count(0)


def test_a_long_recording_is_seen_whole_and_to_the_sample(quiet: tuple[Site, list[str]]) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER)
    page.goto(f"/recordings/{ids[2]}")
    assert "60000 samples at 10000 Hz" in page.page.locator("section[aria-labelledby=waveforms]").inner_text()
    # The first paint needs nothing but the page itself, and is told for the benchmark.
    page.page.wait_for_function("() => performance.getEntriesByName('charts: first paint').length === 1")
    drawn = page.page.locator(f"{chart(page.page, 'voltages')} .u-over")
    drawn.scroll_into_view_if_needed()
    box = drawn.bounding_box()
    assert box is not None
    with page.page.expect_response(lambda answer: "/samples?" in answer.url) as answered:
        page.page.mouse.move(box["x"] + 0.50 * box["width"], box["y"] + 60)
        page.page.mouse.down()
        page.page.mouse.move(box["x"] + 0.51 * box["width"], box["y"] + 60, steps=4)
        page.page.mouse.up()
    content = answered.value.body()
    head = json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])
    assert head["first_s"] == pytest.approx(3.0, abs=0.03)
    assert head["last_s"] == pytest.approx(3.06, abs=0.03)
    assert {one["of"] for one in head["columns"]} == {"time", "value"}
    # Once the samples are there, the cursor reads one of them, and no extremes any more.
    press(page.page, "voltages", "ArrowRight")
    expect(page.page.locator(f"{chart(page.page, 'voltages')} [data-chart-readout]")).not_to_contain_text(
        " to "
    )


def test_what_is_dropped_is_brought(quiet: tuple[Site, list[str]], tmp_path: Path) -> None:
    site, _ = quiet
    page = site.open(Role.ENGINEER)
    page.goto("/recordings?motor=FAN-A2")
    files = page.page.evaluate_handle(
        """([cfg, dat]) => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([cfg], "E.CFG"));
            transfer.items.add(new File([dat], "E.DAT"));
            return transfer;
        }""",
        [CFG.decode(), DAT.decode()],
    )
    page.page.dispatch_event("[data-drop]", "drop", {"dataTransfer": files})
    expect(page.page.locator("[data-drop-said]")).to_have_text("E.CFG, E.DAT")
    page.page.get_by_role("button", name="Upload").click()
    expect(page.page.locator("#messages")).to_contain_text("stored, and waits for its diagnosis")
    expect(page.page.locator("h1")).to_contain_text("FAN-A2")
    page.require_accessible()


def test_files_are_chosen_without_a_script(quiet: tuple[Site, list[str]], tmp_path: Path) -> None:
    site, _ = quiet
    for name, content in (("E.CFG", CFG), ("E.DAT", DAT)):
        (tmp_path / name).write_bytes(content)
    page = site.open(Role.ENGINEER, javascript=False)
    page.goto("/recordings?motor=PUMP-A1")
    page.page.set_input_files("input[type=file]", [tmp_path / "E.CFG", tmp_path / "E.DAT"])
    page.page.get_by_role("button", name="Upload").click()
    assert "waits for its diagnosis" in page.page.inner_text("main")


def test_a_viewer_is_not_asked_for_files(quiet: tuple[Site, list[str]]) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER)
    page.goto("/recordings")
    expect(page.page.locator("form[data-upload]")).to_have_count(0)
    page.goto(f"/recordings/{ids[0]}")
    expect(page.page.get_by_role("button", name="Diagnose again")).to_have_count(0)


def test_on_a_phone_the_sentence_the_envelope_and_the_phasors_come_first(
    quiet: tuple[Site, list[str]],
) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER, screen=PHONE, dark=True)
    page.goto(f"/recordings/{ids[2]}")
    page.page.wait_for_selector(f"{chart(page.page, 'voltages')} canvas")
    page.require_no_sideways_scroll()
    tops = [
        page.page.locator(selector).first.bounding_box()
        for selector in (".said", chart(page.page, "voltages"), "#phasors", "#parameters")
    ]
    heights = [box["y"] for box in tops if box is not None]
    assert heights == sorted(heights)
    assert heights[1] < 2 * PHONE[1], "the envelope is on the first or the second screen"
    page.require_accessible()


def test_without_a_script_the_model_is_a_link_away(quiet: tuple[Site, list[str]]) -> None:
    site, ids = quiet
    page = site.open(Role.VIEWER, javascript=False)
    page.goto(f"/recordings/{ids[1]}")
    page.page.get_by_role("link", name="What the model leaves of the currents").click()
    assert "as the diagnosis says" in page.page.inner_text("#model")
    assert page.page.locator(f"{chart(page.page, 'residual')} table tbody tr").count() > 30
    page.goto(f"/recordings/{ids[1]}?with={ids[0]}")
    assert page.page.locator("section[aria-labelledby=compare] tbody tr").count() > 10


def test_a_diagnosis_that_comes_is_shown_to_who_waits(quiet: tuple[Site, list[str]]) -> None:
    site, _ = quiet
    record = running_record(begin_ns=NOW_NS + 3 * HOUR_NS, fault=Fault(0.05, 2))
    waiting = add_recording(site.repository, site.context.store, record, diagnosed=False)
    page = site.open(Role.VIEWER)
    page.goto(f"/recordings/{waiting}")
    expect(page.page.locator(".said")).to_have_text("It waits for its diagnosis.")
    again = add_recording(site.repository, site.context.store, record)
    assert again == waiting
    expect(page.page.locator(".said")).to_contain_text("Shorted turns in phase c")
    expect(page.page.locator("#found")).to_contain_text(re.compile(r"All \d+ passed"))
    page.page.wait_for_selector(f"{chart(page.page, 'residual')} canvas")
