"""Relay reports: what they say, and what is said of those that cannot be read."""

import pickle
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.recordings.cev.compressed_ascii import closed
from core.relay_reports import (
    ReportError,
    ReportKind,
    StateChange,
    clock_of_report,
    kind_of_report,
    read_load_profile,
    read_motor_starts,
    read_motor_statistics,
    read_sequence_of_events,
)
from core.relay_reports.clock_times import DateOrder
from core.relay_reports.report_text import MOST_BYTES
from core.time_stamps import nanoseconds
from tests.core.relay_reports.examples import CLDP, CSER, HEAD, LDP, MOT, MSR, MSR_BY_PHASE, SER, compressed

STARTED_NS = nanoseconds("2026-03-29T10:15:01.250Z")
RUNNING_NS = nanoseconds("2026-03-29T10:15:02.500Z")


def test_a_sequence_of_events_is_in_order_of_time_and_keeps_messages() -> None:
    changes = read_sequence_of_events(SER)
    assert changes == (
        StateChange(nanoseconds("2026-03-28T23:59:59.999Z"), "Relay Powered Up", asserted=None),
        StateChange(STARTED_NS, "STARTING", asserted=True),
        StateChange(RUNNING_NS, "STARTING", asserted=False),
        StateChange(RUNNING_NS, "RUNNING", asserted=True),
    )
    assert read_sequence_of_events(CSER) == (changes[1], changes[3])


def test_a_sequence_with_the_oldest_first_is_the_same_by_its_numbers() -> None:
    """Manuals of the SEL-351A and the SEL-751 say that SER shows row 1, the newest, at the end."""
    head, _, rows = SER.partition("STATE\n")
    upwards = "".join(reversed(rows.splitlines(keepends=True)))
    assert read_sequence_of_events(f"{head}STATE\n{upwards}") == read_sequence_of_events(SER)


def test_reports_in_the_layout_that_manuals_print() -> None:
    """Two lines of heading (SEL-749M, 20080918, 1.6); numbered rows of load (SEL-734, 20090730, 10.28)."""
    heading = (
        "=>>LDP 2 <Enter>\n"
        "SEL-749M                      Date: 05/21/08   Time: 08:15:09.609\n"
        "MOTOR RELAY                   Time Source: internal\n"
        "FID=SEL-749M-R102-V0-Z002002-D20041022   CID=3BB9\n\n"
    )
    profile = (
        heading + "#   DATE       TIME      IA_MAG  VAB_MAG\n1   05/21/2008 08:00:00  12.500  401.200\n=>>\n"
    )
    rows = read_load_profile(profile)
    assert rows.values["VAB_MAG"].tolist() == [401.2]
    assert clock_of_report(profile) == nanoseconds("2008-05-21T08:15:09.609Z")
    for nothing in ("No Load Profile Data", "No data available."):
        assert read_load_profile(heading + nothing).time_ns.size == 0
    assert read_sequence_of_events(heading + "No SER data.") == ()


def test_a_clock_is_found_in_a_heading_alone() -> None:
    assert clock_of_report(MSR) == nanoseconds("2026-03-29T10:15:30.125Z")
    assert clock_of_report(CSER) is None
    with pytest.raises(ReportError, match="date"):
        clock_of_report(MSR, date_order=DateOrder.YMD)


def test_a_load_profile_has_the_columns_that_it_names() -> None:
    for report in (LDP, CLDP):
        rows = read_load_profile(report)
        assert rows.time_ns.tolist() == [
            nanoseconds("2026-03-29T10:14:00Z"),
            nanoseconds("2026-03-29T10:15:00Z"),
        ]
        assert rows.values["IA_MAG"] == pytest.approx([1.203, 1.305])
        assert rows.values["P"] == pytest.approx([436.2, 512.9])
    assert list(read_load_profile(LDP).values) == ["IA_MAG", "IB_MAG", "P"]


def test_motor_statistics_are_told_in_units() -> None:
    found = read_motor_statistics(MOT)
    assert found.since_ns == nanoseconds("2026-03-01T00:00:00Z")
    assert (found.running_s, found.stopped_s) == (120 * 3600 + 330, 3 * 3600)
    assert found.starts == 17
    assert (found.mean_current_A, found.peak_current_A, found.peak_start_current_A) == (1.21, 1.74, 8.90)
    assert found.longest_start_s == 0.42
    assert found.trips == {"overcurrent": 1, "thermal overload": 0}
    assert found.time_ns == nanoseconds("2026-03-29T10:15:30.125Z")
    assert read_motor_statistics(HEAD + "Number of starts   3\n").running_s is None


def test_a_start_report_has_every_start_with_its_curve() -> None:
    unfinished, start = read_motor_starts(MSR)
    assert start.time_ns == STARTED_NS
    assert (start.duration_s, start.peak_current_A, start.lowest_voltage_V) == (0.30, 8.62, 371.5)
    assert start.curve_time_s == pytest.approx([0.1, 0.2, 0.3])
    assert start.curve_current_A == pytest.approx([8.62, 7.10, 1.31])
    assert start.curve_voltage_V == pytest.approx([371.5, 372.0, 380.2])
    assert unfinished.duration_s is None
    assert unfinished.curve_current_A == pytest.approx([9.01])


def test_a_start_by_phase_between_commas_is_meant_over_the_phases() -> None:
    """As the SEL-701 and SEL-749M manuals say of theirs: every few cycles, between commas, by phase."""
    (start,) = read_motor_starts(MSR_BY_PHASE, frequency_Hz=50.0)
    assert start.time_ns == STARTED_NS
    assert start.duration_s == 0.3
    assert start.peak_current_A is None
    assert start.curve_time_s == pytest.approx([0.1, 0.2])
    assert start.curve_current_A == pytest.approx([8.6, 7.1])
    assert start.curve_voltage_V == pytest.approx([372.0, 372.0])
    with pytest.raises(ReportError, match="CYCLE: expected the line frequency"):
        read_motor_starts(MSR_BY_PHASE)


def test_a_relay_without_data_is_not_an_error() -> None:
    assert read_motor_starts(HEAD + "MOTOR START REPORT\n\nNo Motor Start Data Available\n") == ()
    assert read_load_profile("=>LDP\nNo data available\n").time_ns.size == 0
    assert read_load_profile(b"\x02" + closed('"No Data Available"') + b"\x03").values == {}
    assert read_sequence_of_events(HEAD + "No SER Data") == ()
    heading = HEAD + "#  DATE  TIME  ELEMENT  STATE\n"
    assert read_sequence_of_events(heading) == ()


def test_dates_are_in_the_order_of_the_relays_setting() -> None:
    for order, date in (
        (DateOrder.YMD, "2026/03/29"),
        (DateOrder.DMY, "29/03/2026"),
        (DateOrder.MDY, "3/29/26"),
    ):
        report = SER.replace("03/29/2026 10", f"{date} 10").replace("4     03/28", "5     ")
        report = "\n".join(line for line in report.splitlines() if not line.startswith("5"))
        assert read_sequence_of_events(report, date_order=order)[0].time_ns == STARTED_NS


@pytest.mark.parametrize(
    ("report", "kind"),
    [
        (SER.encode(), "SER"),
        (CSER, "SER"),
        (LDP.encode(), "LDP"),
        (CLDP, "LDP"),
        (MOT.encode(), "MOT"),
        (MSR.encode(), "MSR"),
        (MSR_BY_PHASE.encode(), "MSR"),
        (MSR.replace("7.10", "x").encode(), "MSR"),
        (LDP.replace("1.203", "x").encode(), "LDP"),
        ((HEAD + "LOAD PROFILE\n\nNo Load Profile Data\n").encode(), "LDP"),
        ((HEAD + "MOTOR START REPORT\n\nNo Motor Start Data Available\n").encode(), "MSR"),
    ],
)
def test_the_kind_of_a_report_is_found_though_it_has_an_error_or_no_data(report: bytes, kind: str) -> None:
    assert kind_of_report(report) == ReportKind(kind)


def test_a_text_that_is_no_report_has_no_kind() -> None:
    with pytest.raises(ReportError, match=r"end: expected a report of motor starts \(MSR\)"):
        kind_of_report("hello")


@pytest.mark.parametrize("year", ["1969", "9999"])
def test_a_year_that_no_relay_has_is_refused(year: str) -> None:
    with pytest.raises(ReportError, match=f"a year from 1970 to 2199, found '{year}'"):
        read_load_profile(LDP.replace("03/29/2026 10:14", f"03/29/{year} 10:14"))


def test_a_file_is_read_like_its_text(tmp_path: Path) -> None:
    path = tmp_path / "SER.TXT"
    path.write_bytes(SER.replace("\n", "\r\n").encode("ascii"))
    assert read_sequence_of_events(path) == read_sequence_of_events(SER)
    with pytest.raises(FileNotFoundError):
        read_sequence_of_events(tmp_path / "none")


Reader = Callable[[str | bytes], object]


@pytest.mark.parametrize(
    ("reader", "report", "told"),
    [
        (read_sequence_of_events, "hello", r"SER: end: expected a heading with DATE, TIME, ELEMENT, STATE"),
        (
            read_sequence_of_events,
            SER.replace("03/29", "13/29"),
            "line 7, time: expected a date and time that",
        ),
        (
            read_sequence_of_events,
            SER.replace("10:15:01.250", "10.15"),
            "line 9, time: expected a time such",
        ),
        (
            read_sequence_of_events,
            SER + "and more\n",
            "line 11: expected number, date, time, element and state",
        ),
        (read_sequence_of_events, CSER.replace(b"RUNNING", b"RUNNINg"), "checksum"),
        (read_sequence_of_events, compressed('"A"', "1"), "expected a line of labels with MONTH"),
        (read_load_profile, LDP.replace("1.203", "nan"), "line 7, IA_MAG: expected a number, found 'nan'"),
        (read_load_profile, LDP.replace("1.203", "1e400"), "line 7, IA_MAG: expected a number"),
        (read_load_profile, LDP.replace("       436.2", ""), "line 7: expected 5 fields, found '4 fields'"),
        (
            read_load_profile,
            LDP.replace("IB_MAG", "IA_MAG"),
            "heading: expected at most 64 labels, each once",
        ),
        (read_load_profile, "IA TIME DATE\n", "heading: expected TIME behind DATE"),
        (read_motor_statistics, HEAD, '"Running time" or "Number of starts", found neither'),
        (read_motor_statistics, MOT.replace(HEAD, ""), "expected the relay's clock, as Date: and Time:"),
        (read_motor_statistics, MOT.replace(" 17", " 1.5"), "expected a whole number"),
        (read_motor_statistics, MOT.replace("120:05:30", "120:75"), "expected hours such as"),
        (read_motor_statistics, MOT + "Number of starts   4\n", "expected each entry once"),
        (read_motor_starts, MOT, '"Date of start" with date and time'),
        (read_motor_starts, MSR.replace("   0.20", "   0.05"), "expected times that rise"),
        (read_motor_starts, MSR.replace("I(A)", "X(A)"), r"expected a column I\(A\)"),
        (read_motor_starts, MSR.replace("0.30 s", "soon"), "duration_s: expected a number, found 'soon'"),
        (read_motor_starts, "x" * 3000, "expected at most 2000 characters"),
        (read_motor_starts, "\n" * 300_000, "expected at most 200000 lines"),
        (read_motor_starts, b" " * (MOST_BYTES + 1), "size: expected at most 8388608 bytes"),
        (read_motor_starts, "\x00\x01", "expected plain text"),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_place(
    reader: Reader, report: str | bytes, told: str
) -> None:
    with pytest.raises(ReportError, match=told) as refused:
        reader(report)
    again = pickle.loads(pickle.dumps(refused.value))  # noqa: S301 - our own
    assert str(again) == str(refused.value)


@given(
    st.sampled_from([SER.encode(), LDP.encode(), MOT.encode(), MSR.encode(), CSER, CLDP]),
    st.integers(0, 900),
    st.binary(max_size=12),
)
def test_damaged_reports_are_read_or_refused(report: bytes, place: int, damage: bytes) -> None:
    damaged = report[:place] + damage + report[place + len(damage) :]
    with suppress(ReportError):
        assert kind_of_report(damaged) in ReportKind
    with suppress(ReportError):
        assert all(change.element or change.asserted is None for change in read_sequence_of_events(damaged))
    with suppress(ReportError):
        assert all(np.all(np.isfinite(column)) for column in read_load_profile(damaged).values.values())
    with suppress(ReportError):
        assert (read_motor_statistics(damaged).starts or 0) >= 0
    with suppress(ReportError):
        assert all(np.all(np.diff(start.curve_time_s) > 0) for start in read_motor_starts(damaged))
