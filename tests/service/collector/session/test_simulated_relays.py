"""The collector against simulated relays of every kind, and against what they do wrong, over real MMS."""

import time
from dataclasses import replace
from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Recording, read
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.misbehaviour import Kind, Misbehaviour
from ied_sim.motor.load import Load, LoadCycle
from ied_sim.motor.plant import rated_current
from ied_sim.profiles.profile import Triggers
from service.collector.session.session_policy import SessionPolicy
from service.plant.recognition import recognise
from service.storage.states import LinkState, RecordingRequestState, RecordingState
from testing.relays.simulated import IED, Simulated, scenario_of, simulated, text
from testing.waiting import eventually
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.expectations import at, expecting
from tests.service.collector.records.policies import with_first_pause
from tests.service.collector.scripted_relay import NAME

RISES_S = 3.0
"""When the load does, since the relay's start."""


def of(bench: Bench, served: Simulated, folder: str) -> Bench:
    """The bench with the simulated relay in its relay's place."""
    points = recognise(served.document.ied(IED))
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
        (
            "sel-710-ed2",
            (always(Kind.NAMES_WITHOUT_PATH), always(Kind.PARTIAL_LISTING, 1)),
        ),
        ("sel-710-ed2", (always(Kind.EMPTY_RPTID), always(Kind.SLOW_REPLIES, 0.02))),
        ("sel-710-ed2", (always(Kind.GROWING_FILE, 1.0),)),
        ("sel-710-ed2", (always(Kind.REPORT_TAKEN),)),
        ("sel-710-ed2", (always(Kind.REPORT_OPTFIELDS_READONLY, 5),)),
        ("sel-710-ed2", (always(Kind.REPORT_WITHOUT_DATA_SET),)),
        ("sel-710-ed2", (always(Kind.FILES_BUSY, for_s=3.0), always(Kind.UNREADABLE_MEASURAND, 1))),
        ("sel-710-ed1", (always(Kind.CUT_MID_FILE, 100, for_s=4.0),)),
        (
            "sel-710-ed1",
            (always(Kind.CLOCK_OFFSET, -86_400.0), always(Kind.FEW_SESSIONS, 1)),
        ),
        ("rdre", (always(Kind.LOCAL_TIME, 7_200.0),)),
        ("sel-710-ed2", (Misbehaviour(Kind.FROZEN, at_s=0.5, for_s=3.0),)),
        ("sel-710-ed2", (Misbehaviour(Kind.RESTART, at_s=1.0, for_s=2.0),)),
    ],
    ids=lambda each: each if isinstance(each, str) else "-".join(m.kind for m in each) or "well",
)
def test_a_request_becomes_a_stored_record(
    bench: Bench, tmp_path: Path, profile: str, misbehaviour: tuple[Misbehaviour, ...]
) -> None:
    scenario = scenario_of(profile, *misbehaviour)
    assert scenario.profile.files is not None
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(bench, served, scenario.profile.files.folder)
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            request_id = here.request()
            session.wake()
            assert eventually(lambda: here.requested(request_id).state is RecordingRequestState.FETCHED, 20)
        (recording,) = here.recordings()
        assert recording.digest is not None
        stored = here.store.find(recording.digest)
        served_files = tmp_path / "relays" / IED / scenario.profile.files.folder
        for file in here.store.directory(stored.digest).iterdir():
            assert file.read_bytes() == (served_files / file.name).read_bytes()


def test_a_record_that_is_never_as_long_as_listed_is_refused_in_writing(bench: Bench, tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2", always(Kind.WRONG_SIZE, 7))
    bench.policy = SessionPolicy(records=with_first_pause(0.005))
    with simulated(tmp_path / "relays", scenario) as served:
        here = of(bench, served, "EVENTS")
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            request_id = here.request()
            session.wake()
            assert eventually(lambda: here.requested(request_id).state is RecordingRequestState.FAILED)
        (recording,) = here.recordings()
    assert recording.digest is None
    assert "expected" in (here.requested(request_id).reason or "")


def test_a_refused_control_fails_the_request_with_its_reason(bench: Bench, tmp_path: Path) -> None:
    with simulated(tmp_path / "relays", scenario_of("sel-710-ed2", always(Kind.REFUSED_CONTROL))) as served:
        here = of(bench, served, "EVENTS")
        request_id = here.request()
        with here.session():
            assert eventually(lambda: here.requested(request_id).state is RecordingRequestState.FAILED)
    assert "blocked by interlocking" in (here.requested(request_id).reason or "")


def test_a_record_of_a_motor_start_is_stored_though_nobody_asked(bench: Bench, tmp_path: Path) -> None:
    """A relay that no client can trigger: it records each start by itself (ER)."""
    with simulated(tmp_path / "relays", scenario_of("rdre-readonly")) as served:
        here = of(bench, served, "COMTRADE")
        assert here.relay.trigger_control is None
        with here.session(), served.client() as operator:
            assert eventually(lambda: here.link() is LinkState.UP)
            assert here.recordings() == []
            operator.operate(served.reference("DR/MOTGGIO1.SPCSO02"), value=True)
            operator.operate(served.reference("DR/MOTGGIO1.SPCSO01"), value=True)
            stored = stored_unasked(here)
    assert stored.trigger_index is not None
    before, after = np.split(np.abs(stored.samples[:3]), [stored.trigger_index], axis=1)
    assert after.max() > 3 * before.max(), "the current of the start"


@pytest.mark.campaign
def test_a_record_of_a_high_load_is_stored_though_nobody_asked(bench: Bench, tmp_path: Path) -> None:
    """A relay that anybody could trigger, and that records a rising load by itself (ER)."""
    scenario = scenario_of("sel-710-ed2")
    rising = Load(0.0, cycle=LoadCycle(((0.0, 0.1), (RISES_S, 0.1), (RISES_S + 0.1, 1.0)), 3_600.0))
    plant = replace(scenario.plant, load=rising)
    with simulated(
        tmp_path / "relays", replace(scenario, plant=plant, triggers=Triggers(load_above=0.8))
    ) as served:
        here = of(bench, served, "EVENTS")
        with here.session(), served.client() as operator:
            assert eventually(lambda: here.link() is LinkState.UP)
            stored = stored_unasked(here)
            assert "ER LOAD" in text(operator, "REPORTS/CHISTORY.TXT")
    assert np.abs(stored.samples[:3]).max() > 0.8 * rated_current(plant.motor) * sqrt(2)


def stored_unasked(bench: Bench) -> Recording:
    """The one recording there is, as the store has it."""
    assert eventually(lambda: [each.state for each in bench.recordings()] == [RecordingState.FETCHED], 60)
    (entry,) = bench.recordings()
    assert (entry.motor, entry.ied) == (MOTOR, bench.relay.name)
    assert bench.repository.recording_requests(limit=10).items == ()
    assert entry.digest is not None
    return read(bench.store.entry(entry.digest))


def test_the_clock_of_a_relay_that_cannot_be_triggered_is_known(bench: Bench, tmp_path: Path) -> None:
    offset_s = -7_200.0
    scenario = scenario_of("rdre-readonly", always(Kind.CLOCK_OFFSET, offset_s))
    with simulated(tmp_path / "relays", scenario) as served:
        here = at(expecting(bench, served.document.ied(IED)), served)

        def is_known() -> bool:
            served.relay.update_metering(time.time_ns())  # sooner than it would be
            return here.repository.relay(NAME).clock_offset_ns is not None

        with here.session():
            assert eventually(is_known)
    ied = here.repository.relay(NAME)
    assert ied.clock_offset_ns is not None
    assert ied.clock_uncertainty_ns is not None
    error_ns = abs(ied.clock_offset_ns - offset_s * NANOSECONDS_PER_SECOND)
    assert error_ns <= ied.clock_uncertainty_ns + NANOSECONDS_PER_SECOND / 2
    assert ied.clock_uncertainty_ns < 10e9
