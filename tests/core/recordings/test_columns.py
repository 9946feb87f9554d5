"""Columns of numbers in text files."""

from pathlib import Path

import numpy as np
import pytest

from core.recordings import RecordingError
from core.recordings.columns import read_columns

ROWS = 20


def written(tmp_path: Path, *lines: str) -> Path:
    path = tmp_path / "record.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_times_give_the_rate_and_the_header_the_names(tmp_path: Path) -> None:
    rows = (f"{k * 2e-4:.4f},{k},{-k}" for k in range(ROWS))
    found = read_columns(written(tmp_path, "recorder 7", "Time [s],Ia,Ib", *rows))
    assert found.names == ("Ia", "Ib")
    assert found.sample_rate_hz == pytest.approx(5_000.0)
    np.testing.assert_array_equal(found.samples[1], -np.arange(ROWS))


def test_one_column_has_neither_name_nor_rate(tmp_path: Path) -> None:
    found = read_columns(written(tmp_path, *(f"{k / 8:.3f}" for k in range(ROWS))))
    assert (found.names, found.sample_rate_hz) == (("1",), None)
    assert found.samples.shape == (1, ROWS)


def test_semicolons_make_decimal_commas(tmp_path: Path) -> None:
    rows = (f"{np.sin(k):.3f};{k % 2},5".replace(".", ",") for k in range(ROWS))
    found = read_columns(written(tmp_path, *rows))
    assert found.sample_rate_hz is None
    assert found.samples[1, 1] == 1.5


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (("a", "b"), "numbers within"),
        (("1,2", *("1" for _ in range(ROWS))), "2 columns"),
        ((*("1" for _ in range(ROWS)), "x"), "numbers"),
        (("1", "2"), "16 rows"),
        (("",), "numbers within"),
    ],
)
def test_what_is_no_table_is_refused_with_what_was_expected(
    tmp_path: Path, lines: tuple[str, ...], expected: str
) -> None:
    with pytest.raises(RecordingError, match=expected):
        read_columns(written(tmp_path, *lines))
