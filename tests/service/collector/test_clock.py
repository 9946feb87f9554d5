"""How far a relay's clock is from ours, and what becomes of that."""

import time

import pytest

from mms import Timestamp
from service.collector.clock import reading
from service.storage.states import ClockQuality, EventReportState
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

OFFSET_S = -3.25
NOT_SYNCHRONISED = 0x20 | 0x0A


def test_a_trigger_compares_the_clocks(bench: Bench, relay: ScriptedRelay) -> None:
    relay.clock_offset_s, relay.clock_quality = OFFSET_S, NOT_SYNCHRONISED
    report = bench.request()
    with bench.session():
        assert bench.reaches(report, EventReportState.FETCHED)
    ied = bench.repository.ied(NAME)
    assert ied.clock_offset_ns is not None
    assert ied.clock_uncertainty_ns is not None
    assert ied.clock_measured_ns is not None
    assert abs(ied.clock_offset_ns / 1e9 - OFFSET_S) <= ied.clock_uncertainty_ns / 1e9
    assert 0 < ied.clock_uncertainty_ns < bench.settings.request_timeout_s * 1e9
    assert abs(time.time_ns() - ied.clock_measured_ns) < 60e9
    assert ied.clock_quality is ClockQuality.NOT_SYNCHRONISED
    (recording,) = bench.recordings()
    assert recording.clock_offset_ns == ied.clock_offset_ns
    assert recording.clock_quality is ClockQuality.NOT_SYNCHRONISED
    assert recording.clock_measured_ns == ied.clock_measured_ns


def test_a_relay_that_stamps_nothing_has_no_known_clock(bench: Bench, relay: ScriptedRelay) -> None:
    report = bench.request()
    with bench.session():
        assert bench.reaches(report, EventReportState.FETCHED)
    assert bench.repository.ied(NAME).clock_offset_ns is None
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
    found = reading(Timestamp(1_000_500, octet), asked_ns=1_000_000, answered_ns=1_000_020)
    assert (found.offset_ns, found.uncertainty_ns, found.quality) == (490, uncertainty_ns, quality)
