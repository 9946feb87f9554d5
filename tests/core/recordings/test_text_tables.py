"""Tables in text files, as loggers, oscilloscopes and spreadsheets write them."""

from pathlib import Path

import numpy as np
import pytest

from core.recordings import RecordingError
from core.recordings.tables.reading import read_table
from core.recordings.tables.table import Table

ROWS = 20
RATE_HZ = 5_000.0


def table(tmp_path: Path, *lines: str, encoding: str = "utf-8", ends: str = "\n") -> Table:
    path = tmp_path / "record.csv"
    path.write_bytes((ends.join(lines) + ends).encode(encoding))
    return read_table(path)


def wave(row: int) -> float:
    return round(float(10.0 * np.sin(row)), 3)


FORMS = {
    "header with units behind names": ["recorder 7", "Time [s],Ia,Ib"]
    + [f"{k / RATE_HZ:.4f},{wave(k)},{-k}" for k in range(ROWS)],
    "PicoScope": ["Time,Channel A", "(ms),(A)", ""] + [f"{k / 5:.6f},{wave(k)}" for k in range(ROWS)],
    "spreadsheet with decimal commas": ["Zeit (ms);I_L1 [A]"]
    + [f"{k / 5:.1f};{wave(k)}".replace(".", ",") for k in range(ROWS)],
    "commas in quotes": ['"Time","Ia"']
    + [f'"{k / RATE_HZ:.4f}","{wave(k)}"'.replace(".", ",") for k in range(ROWS)],
    "tabs": ["X_Value\tCurrent\tComment"] + [f"{k / RATE_HZ:.4f}\t{wave(k)}" for k in range(ROWS)],
    "Rigol": ["X,CH1,Start,Increment", "Sequence,Volt,-0.002,2.0e-04"]
    + [f"{k},{wave(k)},," for k in range(ROWS)],
    "Tektronix": [
        f"{label},{value},,{k / RATE_HZ - 0.002:.6f},{wave(k)},"
        for k, (label, value) in enumerate(
            [("Record Length", "2500"), ("Sample Interval", "2.0e-04"), *[("", "")] * (ROWS - 2)]
        )
    ],
    "Keysight": ["x-axis,1", "second,Volt"] + [f"{k / RATE_HZ:.4e},{wave(k)}" for k in range(ROWS)],
    "rate in the head": ["Sampling rate:,5,kHz", "Ia"] + [f"{wave(k)}" for k in range(ROWS)],
    "interval in the head": ["Sample Interval (ms);0,2", "n;Ia"]
    + [f"{k};{wave(k)}".replace(".", ",") for k in range(ROWS)],
    "dates": ["Timestamp,Ia"] + [f"2026-01-31T12:00:00.{200 * k:06d}Z,{wave(k)}" for k in range(ROWS)],
    "German dates": ["Datum;Ia"]
    + [f"31.01.2026 12:00:00,{2 * k:04d};{wave(k)}".replace(".0 ", " ") for k in range(ROWS)],
    "unit in words": ["Zeit in ms;I L1 [A]"] + [f"{k / 5:.1f};{wave(k)}" for k in range(ROWS)],
    "words behind": ["t,Ia"] + [f"{k / RATE_HZ:.4f},{wave(k)}" for k in range(ROWS)] + ["", "END OF DATA"],
    "rate in a comment": ["# fs = 5000", "Ia"] + [f"{wave(k)}" for k in range(ROWS)],
    "microseconds in the name": ["time_us,Ia"] + [f"{200 * k},{wave(k)}" for k in range(ROWS)],
    "seconds since 1970": ["time,Ia"] + [f"{1769860800 + k / RATE_HZ:.4f},{wave(k)}" for k in range(ROWS)],
    "no header": [f"{k / RATE_HZ:.4f} {wave(k)}" for k in range(ROWS)],
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_each_form_gives_its_rate_and_its_samples(tmp_path: Path, form: str, encoding: str) -> None:
    found = table(tmp_path, *FORMS[form], encoding=encoding, ends="\r\n")
    assert found.sample_rate_hz == pytest.approx(RATE_HZ, rel=1e-3)
    assert found.instants_s is None
    np.testing.assert_allclose(found.columns[0].values, [wave(k) for k in range(ROWS)])


@pytest.mark.parametrize("form", ["dates", "German dates", "seconds since 1970"])
def test_dates_give_the_start(tmp_path: Path, form: str) -> None:
    assert table(tmp_path, *FORMS[form]).start_time_ns == 1_769_860_800_000_000_000


def test_names_and_units_are_those_of_the_file(tmp_path: Path) -> None:
    [column] = table(tmp_path, *FORMS["PicoScope"]).columns
    assert (column.name, column.unit) == ("Channel A", "A")
    [column] = table(tmp_path, *FORMS["spreadsheet with decimal commas"]).columns
    assert (column.name, column.unit) == ("I_L1 [A]", "A")


def test_a_column_that_numbers_the_rows_gives_no_rate(tmp_path: Path) -> None:
    found = table(tmp_path, "n,IA", *(f"{k},{wave(k)}" for k in range(ROWS)))
    assert (found.names, found.sample_rate_hz, found.numbered_by) == (("IA",), None, "n")


def test_one_column_has_neither_name_nor_rate(tmp_path: Path) -> None:
    found = table(tmp_path, *(f"{k / 8:.3f}" for k in range(ROWS)))
    assert (found.names, found.sample_rate_hz) == (("1",), None)


def test_what_was_not_measured_is_missing(tmp_path: Path) -> None:
    found = table(tmp_path, "t,Ia,Ib", "0,1,", "1e-3,∞,2", *(f"{k}e-3,1,2" for k in range(2, ROWS)))
    assert np.isnan(found.columns[1].values[0])
    assert np.isnan(found.columns[0].values[1])


def test_gaps_keep_the_time_of_every_row(tmp_path: Path) -> None:
    times = [k * 1e-3 + (0.5 if k > 9 else 0.0) for k in range(ROWS)]
    found = table(tmp_path, "time,Ia", *(f"{t:.4f},1" for t in times))
    assert found.instants_s is not None
    np.testing.assert_allclose(found.instants_s, times)


def test_times_in_coarse_steps_repeat(tmp_path: Path) -> None:
    found = table(tmp_path, "Time (ms),Ia", *(f"{k // 4},1" for k in range(10 * ROWS)))
    assert found.sample_rate_hz == pytest.approx(4_000.0, rel=0.05)


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (("a", "b"), "numbers begin within"),
        (("1,2.5", *("1" for _ in range(ROWS))), "1 columns, as below it"),
        ((*("1" for _ in range(ROWS)), "x"), "a number"),
        (("1", "2"), "16 rows"),
        (("",), "numbers begin within"),
        (("time,Ia", *(f"{k % 7},1" for k in range(ROWS))), "step back in row 8"),
        (tuple(f"0,{k:04d},1,{k:03d}" for k in range(ROWS)), "comma may be either"),
    ],
)
def test_what_is_no_table_is_refused_with_what_was_expected(
    tmp_path: Path, lines: tuple[str, ...], expected: str
) -> None:
    with pytest.raises(RecordingError, match=expected):
        table(tmp_path, *lines)
