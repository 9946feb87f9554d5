"""Texts of relays, files and people that would be markup or a script are text on every page."""

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser

from core.condition.events import Event, EventKind
from core.recordings import Channel, Digitals, Quantity, Recording
from service.configuration.settings import sqlite_url
from service.plant import Plant
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.records import COMMAND_LINE, Actor, RelayFindings, Role
from service.storage.states import AlarmKind, LinkState
from testing.service.accounts import EVERYTHING
from testing.service.conditions import DRIFTING, FAULT, tell
from testing.service.database import make_database
from testing.service.diagnosed import add_diagnosed
from testing.service.job_runner import register_runner
from testing.service.links import set_link_state
from testing.service.plants import fault, two_motor_plant
from testing.service.real_recordings import add_recording, running_record
from testing.web.pages import address_of, is_page, page_routes, roles_for
from testing.web.site import Site, running_site

SCRIPT = "<script>window.harmed=1</script>"
IMAGE = '"><img src=x onerror=window.harmed=1>'
TEMPLATE = "{{7*7}}${7*7}</textarea></title>' onmouseover='window.harmed=1"
HOSTILE = (SCRIPT, IMAGE, TEMPLATE)
USERS = {"eve": EVERYTHING, "paul": (Role.SECAUD,)}
HARMED = "() => window.harmed === 1 || document.querySelector('[onerror], [onmouseover]') !== null"


def hostile_plant() -> Plant:
    """A plant whose sites, relays and motors have such names."""
    plant = two_motor_plant()
    site, relay, pump = plant.sites[0], plant.relays[0], plant.motors[0]
    return Plant(
        sites=tuple(replace(site, name=name, description=name) for name in HOSTILE),
        relays=tuple(replace(relay, name=name, site=name, manufacturer=name, type=name) for name in HOSTILE),
        motors=tuple(
            replace(pump, motor=replace(pump.motor, name=name), description=name, site=name, relay=name)
            for name in HOSTILE
        ),
    )


def hostile_waveform() -> Recording:
    """A recording whose channels, states, units and station have such names."""
    record = running_record()
    assert record.digitals is not None
    names = (SCRIPT, IMAGE, TEMPLATE, SCRIPT * 2, IMAGE * 2, TEMPLATE * 2)
    channels = tuple(replace(one, name=name) for one, name in zip(record.channels, names, strict=True))
    spare = Channel(IMAGE * 3, Quantity.OTHER, None, SCRIPT[:20], 10.0)
    moving = np.zeros((len(record.samples[0]), 2), dtype=bool)
    moving[100:200, 0] = moving[300:, 1] = True
    return replace(
        record,
        channels=(*channels, spare),
        samples=np.vstack([record.samples, record.samples[:1]]),
        digitals=Digitals.of((SCRIPT, IMAGE), moving),
        station=TEMPLATE,
    )


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Site]:
    """A site in which every text that somebody else may choose is one of those."""
    data: Path = tmp_path_factory.mktemp("hostile")
    make_database(data)
    engine = connect(sqlite_url(data))
    repository, store = Repository(engine), FolderStore(data / "recordings")
    register_runner(repository)
    now_ns = time.time_ns()
    repository.sync_plant(hostile_plant(), noted_ns=now_ns)
    for name in HOSTILE:
        by = Actor(name, name, frozenset({Role.ENGINEER}))
        diagnosis = replace(fault(), reasons=(name,))
        add_diagnosed(repository, store, diagnosis, now_ns, motor=name, name=name.replace("/", "_"))
        condition = replace(
            FAULT if name == SCRIPT else DRIFTING, motor=name, as_of_ns=now_ns, reasons=(name,), advice=name
        )
        tell(repository, condition, now_ns=now_ns)
        repository.add_event(
            name, Event(now_ns, EventKind.NOTE, name), by=by, on_behalf_of=name, now_ns=now_ns
        )
        set_link_state(repository, name, LinkState.DOWN, name, now_ns=now_ns)
        alarm = repository.raise_alarm(name, AlarmKind.FILE_REFUSED, name, name, now_ns=now_ns)
        repository.acknowledge_alarm(alarm.id, by=by, comment=name, now_ns=now_ns)
        difference = {"kind": name, "expected": name, "found": name}
        ignored = {"name": name, "reason": name}
        repository.note_findings(RelayFindings(name, now_ns, ACQUISITION, [difference], [ignored], 1))
    for user, roles in USERS.items():
        repository.add_user(
            user, roles, full_name=SCRIPT, password=None, by=Actor(SCRIPT, COMMAND_LINE), now_ns=now_ns
        )
    repository.add_token(
        "eve", IMAGE, "0" * 64, scope=None, expires_ns=None, by=Actor("eve", ""), now_ns=now_ns
    )
    repository.settle_alarms(now_ns=now_ns)
    add_recording(repository, store, hostile_waveform(), diagnosed=False, name=IMAGE)
    engine.dispose()
    with running_site(data, browser) as site:
        yield site
        problems = site.close_pages()
    assert not problems, "\n".join(problems)


ACQUISITION = {
    "asked": True, "trigger": SCRIPT, "trigger_action": "set-reset", "control_model": IMAGE,
    "record_made": SCRIPT, "record_number": None, "records_told_by": "polling", "report_control": IMAGE,
    "events_directory": SCRIPT, "overridden": [TEMPLATE], "remarks": [SCRIPT, IMAGE],
}  # fmt: skip


@pytest.mark.parametrize("route", page_routes())
def test_no_text_is_markup_on_any_page(hostile: Site, route: str) -> None:
    path = address_of(route, hostile.repository)
    assert path is not None
    (user,) = [name for name, roles in USERS.items() if roles == roles_for(path)]
    if not is_page(hostile.url, path, hostile.log_in(user=user)):
        return
    page = hostile.open(user=user)
    for query in (
        "",
        f"?text={'%3Cscript%3Ewindow.harmed%3D1%3C%2Fscript%3E'}&site=%22%3E%3Cimg%20src%3Dx%3E",
    ):
        if route == "/search":  # it leads to the motor of that name, which no plant's file may have
            page.accepted.add(404)
        page.goto(path + query)
        page.page.wait_for_function("() => document.documentElement.dataset.ready === 'true'")
        assert not page.page.evaluate(HARMED), f"{path}{query} made markup of a text"
        assert page.page.locator("main img[src=x]").count() == 0
        assert "7*7" in page.page.content() or "49" not in page.page.locator("h1").inner_text()


def test_names_of_channels_and_states_are_text_where_scripts_write_them(hostile: Site) -> None:
    """Legends, values at the cursor, rows of states and the table of markers."""
    (recording,) = [one for one in hostile.repository.recordings(limit=50).items if one.name == "EVENT"]
    page = hostile.open(user="eve")
    page.goto(f"/recordings/{recording.id}")
    page.page.wait_for_function("() => document.documentElement.dataset.ready === 'true'")
    legend = page.page.locator("[data-chart-legend] button")
    assert any(SCRIPT in one for one in legend.all_inner_texts())
    for place in page.page.locator("[data-chart-place]").all():
        place.focus()
        for key in ("ArrowRight", "+", "+", "+", "1", "ArrowRight", "2"):
            place.press(key)
    readouts = page.page.locator("[data-chart-readout]").all_inner_texts()
    assert any(SCRIPT in one or IMAGE in one for one in readouts)
    assert not page.page.evaluate(HARMED)
    assert page.page.locator("main img[src=x]").count() == 0
