"""The simulated relay as its clients see it, over MMS on the loopback interface."""

import io
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Quantity, Recording, read
from core.units import NANOSECONDS_PER_DAY
from ied_sim.relay.plant_clock import ClockSettings
from mms import FunctionalConstraint, Timestamp
from testing.waiting import wait_until
from tests.ied_sim.relay.serving import IED, SHORT_RECORD, TRIGGER_BIT, ServedRelay, served_relay


@pytest.fixture
def served(tmp_path: Path) -> Iterator[ServedRelay]:
    with served_relay(tmp_path / "relay") as relay:
        yield relay


def download(served: ServedRelay, directory: Path) -> Path:
    """Every file of the EVENTS directory; the path of the newest configuration."""
    for entry in served.client.files("EVENTS"):
        content = io.BytesIO()
        served.client.download(entry.name, content, expected_size=entry.size)
        (directory / entry.name.rpartition("/")[2]).write_bytes(content.getvalue())
    return max(directory.glob("*.CFG"))


def fetch(served: ServedRelay, directory: Path) -> Recording:
    return read(download(served, directory))


def test_operating_rb01_makes_a_record_that_can_be_fetched_when_announced(
    served: ServedRelay, tmp_path: Path
) -> None:
    before_ns = time.time_ns()
    served.pulse()
    after_ns = time.time_ns()
    number = served.next_record()
    assert served.names() == [f"HR_{number}.{suffix}" for suffix in ("CFG", "DAT", "HDR")]

    recording = fetch(served, tmp_path)
    assert [channel.name for channel in recording.channels] == ["IA", "IB", "IC", "VA", "VB", "VC"]
    assert [channel.phase for channel in recording.channels] == ["a", "b", "c", "a", "b", "c"]
    assert [channel.quantity for channel in recording.channels] == [Quantity.CURRENT] * 3 + [
        Quantity.PHASE_VOLTAGE
    ] * 3
    assert recording.sample_rate_hz == SHORT_RECORD.sample_rate_hz
    assert recording.samples.shape == (6, 400)
    assert recording.trigger_index == 100
    assert before_ns - 1000 <= recording.trigger_time_ns <= after_ns
    assert recording.nominal_frequency_hz == 50
    rms = np.sqrt(np.mean(recording.samples**2, axis=1))
    assert rms[:3] == pytest.approx([1.203] * 3, rel=0.01)
    assert rms[3:] == pytest.approx([380 / np.sqrt(3)] * 3, rel=0.01)


def test_the_header_is_a_summary_without_the_truth(served: ServedRelay, tmp_path: Path) -> None:
    served.pulse()
    served.next_record()
    header = download(served, tmp_path).with_suffix(".HDR").read_text()
    assert IED in header
    assert "UTC" in header
    assert "50.00 Hz" in header
    assert "mu" not in header
    assert "load" not in header.lower()


def test_a_record_takes_its_time(tmp_path: Path) -> None:
    """The announcement comes when the last sample has been, and hardly later."""
    with served_relay(tmp_path, replace(SHORT_RECORD, post_trigger_s=0.5)) as served:
        begin_s = time.monotonic()
        served.pulse()
        served.next_record()
        assert 0.5 <= time.monotonic() - begin_s < 2.0


def test_every_record_is_announced_by_a_rise_of_record_made(served: ServedRelay) -> None:
    served.pulse()
    assert served.next_value("RcdMade") is True
    served.pulse()
    assert served.next_value("RcdMade") is False
    assert served.next_value("RcdMade") is True


def test_announcements_carry_their_time(served: ServedRelay) -> None:
    begin_ns = time.time_ns()
    served.pulse()
    served.next_record()
    for name in ("RcdMade", "FltNum"):
        value = served.client.read(f"{IED}PRO/FLTRDRE1.{name}.t", FunctionalConstraint.ST)
        assert isinstance(value, Timestamp)
        assert begin_ns < value.ns < time.time_ns()


def test_a_relay_of_the_past_writes_the_past_and_stamps_the_present(tmp_path: Path) -> None:
    days_ago = ClockSettings(start_days_ago=2.0, speed_up=2.0, leap_every_s=1000.0)
    with served_relay(tmp_path / "relay", clock=days_ago) as served:
        begin_ns = time.time_ns()
        served.pulse()
        served.next_record()
        stamp = served.client.read(f"{IED}PRO/FLTRDRE1.RcdMade.t", FunctionalConstraint.ST)
        assert isinstance(stamp, Timestamp)
        assert begin_ns < stamp.ns < time.time_ns()
        recording = fetch(served, tmp_path)
        assert (begin_ns - recording.trigger_time_ns) / NANOSECONDS_PER_DAY == pytest.approx(2.0, abs=1e-4)


def test_a_pickup_during_a_capture_makes_no_second_record(tmp_path: Path) -> None:
    with served_relay(tmp_path, replace(SHORT_RECORD, post_trigger_s=0.4)) as served:
        for _ in range(3):
            served.pulse()
        first = served.next_record()
        assert len(served.names()) == 3
        served.pulse()
        assert served.next_record() == first + 1
        assert len(served.names()) == 6


def test_a_remote_bit_stays_and_triggers_only_when_it_rises(served: ServedRelay) -> None:
    served.client.operate(TRIGGER_BIT, value=True)
    first = served.next_record()
    assert served.client.read(f"{TRIGGER_BIT}.stVal", FunctionalConstraint.ST) is True
    served.client.operate(TRIGGER_BIT, value=True)
    served.client.operate(TRIGGER_BIT, value=False)
    assert served.client.read(f"{TRIGGER_BIT}.stVal", FunctionalConstraint.ST) is False
    served.client.operate(TRIGGER_BIT, value=True)
    assert served.next_record() == first + 1


def test_other_remote_bits_are_set_and_trigger_nothing(served: ServedRelay) -> None:
    other = f"{IED}CON/RBGGIO1.SPCSO02"
    served.client.operate(other, value=True)
    assert served.client.read(f"{other}.stVal", FunctionalConstraint.ST) is True
    served.pulse()
    number = served.next_record()
    assert served.names() == [f"HR_{number}.{suffix}" for suffix in ("CFG", "DAT", "HDR")]


def test_the_oldest_record_gives_way_to_the_newest(served: ServedRelay) -> None:
    numbers = []
    for _ in range(SHORT_RECORD.capacity + 2):
        served.pulse()
        numbers.append(served.next_record())
    assert numbers == list(range(numbers[0], numbers[0] + 5))
    wait_until(lambda: len(served.names()) == 3 * SHORT_RECORD.capacity, "the ring to be full")
    kept = {name.removeprefix("HR_").split(".")[0] for name in served.names()}
    assert kept == {str(number) for number in numbers[-SHORT_RECORD.capacity :]}


def test_numbers_go_on_after_a_restart(tmp_path: Path) -> None:
    with served_relay(tmp_path) as served:
        served.pulse()
        first = served.next_record()
    with served_relay(tmp_path) as served:
        assert served.client.read(f"{IED}PRO/FLTRDRE1.FltNum.stVal", FunctionalConstraint.ST) == first
        served.pulse()
        assert served.next_record() == first + 1
        assert len(served.names()) == 6


def test_stopping_in_the_middle_of_a_capture_leaves_no_record(tmp_path: Path) -> None:
    with served_relay(tmp_path, replace(SHORT_RECORD, post_trigger_s=30.0)) as served:
        served.pulse()
    assert not list((tmp_path / IED / "EVENTS").iterdir())


def test_a_record_that_cannot_be_written_is_logged_and_the_next_one_made(
    served: ServedRelay, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    staging = tmp_path / "relay" / ".staging" / IED
    staging.rmdir()
    served.pulse()
    wait_until(lambda: "cannot be written" in caplog.text, "the log to tell of the lost record")
    staging.mkdir()
    wait_until(lambda: _made(served), "a record")
    # A second record may be there as well: a trigger follows at once where the first was just complete.
    assert served.names()[:3] == ["HR_10000.CFG", "HR_10000.DAT", "HR_10000.HDR"]


def _made(served: ServedRelay) -> bool:
    served.pulse()
    return len(served.names()) >= 3


def test_nothing_but_what_the_profile_offers_is_in_the_file_store(served: ServedRelay) -> None:
    folders = {entry.name.strip("/").split("/")[0] for entry in served.client.files("")}
    assert folders <= {"EVENTS", "REPORTS", "SETTINGS"}


def test_meters_show_the_motor(served: ServedRelay) -> None:
    time_ns = time.time_ns()
    served.relay.update_metering(time_ns)
    mx = FunctionalConstraint.MX
    current = served.client.read(f"{IED}MET/METMMXU1.A.phsB.cVal.mag.f", mx)
    voltage = served.client.read(f"{IED}MET/METMMXU1.PPV.phsAB.cVal.mag.f", mx)
    frequency = served.client.read(f"{IED}MET/METMMXU1.Hz.mag.f", mx)
    power = served.client.read(f"{IED}MET/METMMXU1.TotW.mag.f", mx)
    positive = served.client.read(f"{IED}MET/METMSQI1.SeqA.c1.cVal.mag.f", mx)
    stamp = served.client.read(f"{IED}MET/METMMXU1.A.phsB.t", mx)
    assert current == pytest.approx(1.203, rel=0.01)
    assert positive == pytest.approx(1.203, rel=0.01)
    assert voltage == pytest.approx(380, rel=0.01)
    assert frequency == pytest.approx(50, abs=0.01)
    assert power == pytest.approx(436, rel=0.02)
    assert isinstance(stamp, Timestamp)
    assert abs(stamp.ns - time_ns) < 100
