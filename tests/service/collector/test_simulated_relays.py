"""The collector against simulated relays of every kind, and against what they do wrong, over real MMS."""

import time
from dataclasses import replace
from pathlib import Path

import pytest

from ied_sim.misbehaviour import Kind, Misbehaviour
from service.plant.recognition import recognise
from service.storage.states import EventReportState, LinkState
from tests.ied_sim.simulating import IED, Simulated, scenario_of, simulated
from tests.service.collector.conftest import Bench, eventually
from tests.service.collector.expectations import at, expecting
from tests.service.collector.scripted_relay import NAME


def of(bench: Bench, served: Simulated, folder: str) -> Bench:
    """The bench with the simulated relay in its relay's place."""
    points = recognise(served.document.ied(IED))
    assert points.trigger is not None
    relay = replace(
        bench.relay,
        host=served.address.host,
        port=served.address.port,
        trigger_control=points.trigger,
        record_made=points.record_made,
        fault_number=points.record_number,
        report_control=points.report_control,
    )
    settings = bench.settings.model_copy(
        update={"events_directory": folder, "record_timeout_s": 15.0, "request_timeout_s": 5.0}
    )
    return replace(bench, relay=relay, settings=settings)


def always(kind: Kind, number: float = 0.0, for_s: float = float("inf")) -> Misbehaviour:
    return Misbehaviour(kind, number, at_s=0.0, for_s=for_s)


@pytest.mark.parametrize(
    ("profile", "misbehaviour"),
    [
        ("sel-710-ed1", ()),
        ("sel-710-ed2", ()),
        ("rdre", ()),
        ("sel-710-ed2", (always(Kind.NAMES_WITHOUT_PATH), always(Kind.PARTIAL_LISTING, 1))),
        ("sel-710-ed2", (always(Kind.EMPTY_RPTID), always(Kind.SLOW_REPLIES, 0.02))),
        ("sel-710-ed2", (always(Kind.GROWING_FILE, 1.0),)),
        ("sel-710-ed2", (always(Kind.REPORT_TAKEN),)),
        ("sel-710-ed1", (always(Kind.CUT_MID_FILE, 100, for_s=4.0),)),
        ("sel-710-ed1", (always(Kind.CLOCK_OFFSET, -86_400.0), always(Kind.FEW_SESSIONS, 1))),
        ("rdre", (always(Kind.LOCAL_TIME, 7_200.0),)),
        ("sel-710-ed2", (Misbehaviour(Kind.FROZEN, at_s=0.5, for_s=3.0),)),
        ("sel-710-ed2", (Misbehaviour(Kind.RESTART, at_s=1.0, for_s=2.0),)),
    ],
    ids=lambda each: each if isinstance(each, str) else "-".join(m.kind for m in each) or "well",
)
def test_a_wish_becomes_a_stored_record(
    bench: Bench, tmp_path: Path, profile: str, misbehaviour: tuple[Misbehaviour, ...]
) -> None:
    scenario = scenario_of(profile, *misbehaviour)
    assert scenario.profile.files is not None
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(bench, served, scenario.profile.files.folder)
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            wish = here.request()
            session.wake()
            assert eventually(lambda: here.report(wish).state is EventReportState.FETCHED, 20)
        (recording,) = here.recordings()
        assert recording.digest is not None
        stored = here.store.find(recording.digest)
        served_files = tmp_path / "relays" / IED / scenario.profile.files.folder
        for file in stored.directory.iterdir():
            assert file.read_bytes() == (served_files / file.name).read_bytes()


def test_a_record_that_is_never_as_long_as_listed_is_refused_in_writing(bench: Bench, tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", always(Kind.WRONG_SIZE, 7))
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(bench, served, "EVENTS")
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            wish = here.request()
            session.wake()
            assert eventually(lambda: here.report(wish).state is EventReportState.FAILED)
        (recording,) = here.recordings()
    assert recording.digest is None
    assert "expected" in (here.report(wish).reason or "")


def test_a_refused_control_fails_the_wish_with_its_reason(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2", always(Kind.REFUSED_CONTROL))) as served:
        here = of(bench, served, "EVENTS")
        wish = here.request()
        with here.session():
            assert eventually(lambda: here.report(wish).state is EventReportState.FAILED)
    assert "blocked by interlocking" in (here.report(wish).reason or "")


def test_the_clock_of_a_relay_that_cannot_be_triggered_is_known(bench: Bench, tmp_path: Path) -> None:
    offset_s = -7_200.0
    scenario = scenario_of("rdre-readonly", always(Kind.CLOCK_OFFSET, offset_s))
    with simulated(tmp_path / "relays", scenario) as served:
        here = at(expecting(bench, served.document.ied(IED)), served)

        def is_known() -> bool:
            served.relay.update_metering(time.time_ns())  # sooner than it would be
            return here.repository.ied(NAME).clock_offset_ns is not None

        with here.session():
            assert eventually(is_known)
    ied = here.repository.ied(NAME)
    assert ied.clock_offset_ns is not None
    assert ied.clock_uncertainty_ns is not None
    assert abs(ied.clock_offset_ns / 1e9 - offset_s) <= ied.clock_uncertainty_ns / 1e9 + 0.5
    assert ied.clock_uncertainty_ns < 10e9
