"""How far a relay's clock is from ours, and what becomes of that."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Event, Thread

import pytest

import scl
from core.units import NANOSECONDS_PER_SECOND
from mms import Client, DataAccessError, Timestamp
from service.collector.session.clock_monitor import ClockMonitor, clock_reading
from service.collector.session.notes import WrittenAtOnce
from service.plant.metering import measurands_from_scl
from service.storage.states import ClockQuality, RecordingRequestState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

OFFSET_S = -3.25
NOT_SYNCHRONISED = 0x20 | 0x0A
CURRENTS = f"{NAME}MET/METMMXU1.A"
VOLTAGES = f"{NAME}MET/METMMXU1.PPV"


@dataclass
class Stamps:
    """What a test's relay does to the stamp of a current. longest_ns: that publishing one ever took."""

    relay: ScriptedRelay
    offset_s: float = OFFSET_S
    longest_ns: int = 0

    def change(self, phase: str = f"{CURRENTS}.phsA") -> None:
        now_ns = time.time_ns()
        stamp = Timestamp(now_ns + round(self.offset_s * NANOSECONDS_PER_SECOND), NOT_SYNCHRONISED)
        self.relay.server.update_many({f"{phase}.t": stamp})
        self.longest_ns = max(self.longest_ns, time.time_ns() - now_ns)

    @contextmanager
    def changing(self, period_s: float) -> Iterator[None]:
        stopping = Event()

        def run() -> None:
            while not stopping.wait(period_s):
                self.change()

        thread = Thread(target=run)
        thread.start()
        try:
            yield
        finally:
            stopping.set()
            thread.join()

    def are_read(self, bench: Bench) -> bool:
        """Whether a reading was made; an AssertionError where it is wrong."""
        ied = bench.repository.relay(NAME)
        if ied.clock_offset_ns is None:
            return False
        assert ied.clock_uncertainty_ns is not None
        error_ns = abs(ied.clock_offset_ns - round(self.offset_s * NANOSECONDS_PER_SECOND))
        assert error_ns <= ied.clock_uncertainty_ns + self.longest_ns
        assert ied.clock_quality is ClockQuality.NOT_SYNCHRONISED
        return True


def test_a_trigger_compares_the_clocks(bench: Bench, relay: ScriptedRelay) -> None:
    relay.clock_offset_s, relay.clock_quality = OFFSET_S, NOT_SYNCHRONISED
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    ied = bench.repository.relay(NAME)
    assert ied.clock_offset_ns is not None
    assert ied.clock_uncertainty_ns is not None
    assert ied.clock_measured_ns is not None
    error_ns = abs(ied.clock_offset_ns - OFFSET_S * NANOSECONDS_PER_SECOND)
    assert error_ns <= ied.clock_uncertainty_ns
    assert 0 < ied.clock_uncertainty_ns < bench.settings.request_timeout_s * NANOSECONDS_PER_SECOND
    assert abs(time.time_ns() - ied.clock_measured_ns) < 60e9
    assert ied.clock_quality is ClockQuality.NOT_SYNCHRONISED
    (recording,) = bench.recordings()
    assert recording.clock_offset_ns == ied.clock_offset_ns
    assert recording.clock_quality is ClockQuality.NOT_SYNCHRONISED
    assert recording.clock_measured_ns == ied.clock_measured_ns


def test_a_relay_that_stamps_nothing_has_no_known_clock(bench: Bench, relay: ScriptedRelay) -> None:
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FETCHED)
    assert bench.repository.relay(NAME).clock_offset_ns is None
    assert [recording.clock_quality for recording in bench.recordings()] == [None]


@pytest.mark.parametrize(
    ("octet", "quality", "uncertainty_ns"),
    [
        (0x0A, ClockQuality.SYNCHRONISED, 10 + 976_562),  # 10 significant bits: about a millisecond
        (0x18, ClockQuality.SYNCHRONISED, 10 + 59),
        (0x1F, ClockQuality.SYNCHRONISED, 10),  # unspecified
        (0x2A, ClockQuality.NOT_SYNCHRONISED, 10 + 976_562),
        (0x6A, ClockQuality.FAILED, 10 + 976_562),
        (0x8A, ClockQuality.SYNCHRONISED, 10 + 976_562),  # leap seconds known
    ],
)
def test_what_a_stamp_tells(octet: int, quality: ClockQuality, uncertainty_ns: int) -> None:
    found = clock_reading(Timestamp(1_000_500, octet), asked_ns=1_000_000, answered_ns=1_000_020)
    assert (found.offset_ns, found.uncertainty_ns, found.quality) == (490, uncertainty_ns, quality)


@pytest.mark.parametrize("period_s", [0.1, pytest.param(2.0, marks=pytest.mark.campaign)])
def test_a_clock_is_read_though_nobody_triggers(bench: Bench, relay: ScriptedRelay, period_s: float) -> None:
    """Of a relay that refreshes what it measures within the close look, and of one that does not."""
    stamps = Stamps(relay)
    with stamps.changing(period_s), bench.session():
        assert eventually(lambda: stamps.are_read(bench))
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"))
    assert relay.edges == 0
    recording = bench.recording("HR_1")
    assert recording is not None
    assert recording.clock_offset_ns == bench.repository.relay(NAME).clock_offset_ns


@pytest.fixture
def monitor(bench: Bench) -> ClockMonitor:
    found = ClockMonitor(NAME, bench.repository, WrittenAtOnce(bench.repository))
    found.begin(measurands_from_scl(scl.read(scl.DEMO_PLANT_SCD).ied(NAME)))
    return found


def test_a_stamp_that_does_not_change_tells_nothing(
    bench: Bench, relay: ScriptedRelay, monitor: ClockMonitor
) -> None:
    """However old it is: nobody knows when it was given."""
    stamps = Stamps(relay)
    with Client.connect("127.0.0.1", relay.port) as client:
        for changes in (True, False, False):
            if changes:
                stamps.change()
            monitor.measure_if_due(client)
            assert not stamps.are_read(bench)
        stamps.change()
        monitor.measure_if_due(client)
    assert stamps.are_read(bench)


def test_a_clock_is_not_read_all_the_time(bench: Bench, relay: ScriptedRelay, monitor: ClockMonitor) -> None:
    stamps = Stamps(relay)

    def measured_ns() -> int | None:
        return bench.repository.relay(NAME).clock_measured_ns

    with Client.connect("127.0.0.1", relay.port) as client:
        found = []
        for _ in range(4):
            stamps.change()
            monitor.measure_if_due(client)
            found.append(measured_ns())
        first = found[1]
        assert found == [None, first, first, first]
        assert first is not None
        monitor.begin(measurands_from_scl(scl.read(scl.DEMO_PLANT_SCD).ied(NAME)))  # a new connection
        for _ in range(2):
            stamps.change()
            monitor.measure_if_due(client)
        assert measured_ns() != first


def test_another_value_is_read_where_one_is_refused(
    bench: Bench, relay: ScriptedRelay, monitor: ClockMonitor
) -> None:
    relay.unreadable = {CURRENTS: DataAccessError.HARDWARE_FAULT}
    stamps = Stamps(relay)
    with Client.connect("127.0.0.1", relay.port) as client:
        for _ in range(5):
            stamps.change(f"{VOLTAGES}.phsAB")
            monitor.measure_if_due(client)
    assert stamps.are_read(bench)


def test_a_service_clock_that_is_set_meanwhile_is_not_the_relay_s_error(
    bench: Bench, relay: ScriptedRelay, monitor: ClockMonitor, monkeypatch: pytest.MonkeyPatch
) -> None:
    stamps = Stamps(relay)
    now_ns = time.time_ns
    with Client.connect("127.0.0.1", relay.port) as client:
        monkeypatch.setattr(time, "time_ns", lambda: now_ns() - 90 * NANOSECONDS_PER_SECOND)
        stamps.change()
        monitor.measure_if_due(client)
        monkeypatch.undo()
        stamps.change()
        monitor.measure_if_due(client)
    assert stamps.are_read(bench)
    uncertainty_ns = bench.repository.relay(NAME).clock_uncertainty_ns
    assert uncertainty_ns is not None
    assert uncertainty_ns < 30 * NANOSECONDS_PER_SECOND
