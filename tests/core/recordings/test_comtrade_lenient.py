"""What a lenient reader mends, and that it says so; the strict one refuses each of these files."""

from pathlib import Path

import numpy as np
import pytest

from core.recordings import Recording, RecordingError, read
from tests.core.recordings.comtrade_files import ANALOG_LINES, RECORD_1999, RECORD_2013, ComtradeFile

ASCII = RECORD_1999.but(data_format="ASCII")


def mended(path: Path, *notes: str) -> Recording:
    """The recording, after the strict reader has refused it and the lenient one has said all of `notes`."""
    with pytest.raises(RecordingError):
        read(path)
    recording = read(path, lenient=True)
    assert len(recording.repairs) == len(notes), recording.repairs
    for repair, note in zip(recording.repairs, notes, strict=True):
        assert repair.endswith(note), repair
        assert repair.startswith("record."), "the file is named"
    return recording


@pytest.mark.parametrize(
    ("record", "note"),
    [
        (RECORD_2013.but(identification="P,R,2024"), "read as the edition of 2013"),
        (
            RECORD_1999.but(analog=tuple(f"1{line}" for line in ANALOG_LINES)),
            "in the order of their lines (so are 3 more)",
        ),
        (RECORD_1999.but(status=("1,TRIP,0", "2,RB01,,,0")), "of such a line only the name is read"),
        (RECORD_1999.but(numbers=(1, 2, 7, 8, 9)), "found 7: samples are taken in the order of the file"),
        (RECORD_1999.but(stamps=(0, 1, 2, 3, 4)), "the time stamps are ignored"),
        (RECORD_1999.but(stamps=(0, 1000, 900, 3000, 4000)), "the time stamps are ignored"),
    ],
)  # fmt: skip
def test_what_bears_on_no_value(tmp_path: Path, record: ComtradeFile, note: str) -> None:
    recording = mended(record.write(tmp_path), note)
    sound = read(RECORD_1999.write(tmp_path))
    np.testing.assert_array_equal(recording.samples, sound.samples)
    np.testing.assert_array_equal(recording.time_s, sound.time_s)
    assert recording.trigger_index == 2


@pytest.mark.parametrize("record", [RECORD_1999, ASCII])
def test_a_cut_file_keeps_its_whole_samples(tmp_path: Path, record: ComtradeFile) -> None:
    path = record.write(tmp_path)
    data = path.with_suffix(".dat")
    whole = read(path)
    cut = (
        data.read_bytes()[:60]
        if record is RECORD_1999
        else b"\r\n".join(data.read_bytes().split(b"\r\n")[:3])
    )
    data.write_bytes(cut)
    recording = mended(path, "3 samples are read")
    np.testing.assert_array_equal(recording.samples, whole.samples[:, :3])


@pytest.mark.parametrize("kept", [10, -5, -2, -1])
def test_a_line_that_was_cut_is_no_sample(tmp_path: Path, kept: int) -> None:
    path = ASCII.write(tmp_path)
    whole = read(path)
    lines = ASCII.data().split(b"\r\n")
    path.with_suffix(".dat").write_bytes(b"\r\n".join([*lines[:3], lines[3][:kept]]))
    recording = mended(path, "3 samples are read")
    np.testing.assert_array_equal(recording.samples, whole.samples[:, :3])


def test_a_value_that_may_have_lost_digits_is_none(tmp_path: Path) -> None:
    record = ASCII.but(counts="4,4A,0D", status=())
    path = record.write(tmp_path)
    path.with_suffix(".dat").write_bytes(b"\r\n".join(record.data().split(b"\r\n")[:4]))
    assert mended(path, "3 samples are read").samples.shape == (4, 3)


def test_a_last_line_of_too_few_fields_is_left_out(tmp_path: Path) -> None:
    path = ASCII.write(tmp_path)
    path.with_suffix(".dat").write_bytes(ASCII.data()[:-8])
    assert mended(path, "4 samples are read").samples.shape == (4, 4)


def test_a_trigger_that_was_cut_off_is_left_out(tmp_path: Path) -> None:
    path = RECORD_1999.write(tmp_path)
    path.with_suffix(".dat").write_bytes(RECORD_1999.data()[:20])
    assert mended(path, "1 samples are read", "the trigger is left out").trigger_index is None


def test_bytes_behind_the_last_sample_are_no_samples(tmp_path: Path) -> None:
    path = RECORD_1999.write(tmp_path)
    path.with_suffix(".dat").write_bytes(RECORD_1999.data() + b"\x00" * 7)
    assert mended(path, "found 97 bytes: 5 samples are read").samples.shape == (4, 5)


def test_blank_lines_are_passed_over_where_the_others_add_up(tmp_path: Path) -> None:
    path = ASCII.write(tmp_path)
    sound = read(path)
    doubled = ASCII.data().replace(b"\r\n", b"\r\n\r\n")
    path.with_suffix(".dat").write_bytes(doubled)
    recording = read(path)
    np.testing.assert_array_equal(recording.samples, sound.samples)
    (warning,) = recording.warnings
    assert "expected 5 lines, one a sample, found 9 lines: the 4 blank lines are passed over" in warning
    lines = doubled.split(b"\r\n")
    path.with_suffix(".dat").write_bytes(b"\r\n".join(lines[:7]))
    assert mended(path, "blank lines are passed over", "4 samples are read").samples.shape == (4, 4)


def test_a_skew_beyond_a_sample_is_left(tmp_path: Path) -> None:
    line = ANALOG_LINES[1].replace(",0,0,-", ",0,-1000,-")
    path = RECORD_1999.but(analog=(ANALOG_LINES[0], line, *ANALOG_LINES[2:])).write(tmp_path)
    mended(path, "found -1000 us: the channel is left as recorded")


def test_a_combined_file_of_another_size(tmp_path: Path) -> None:
    path = tmp_path / "record.cff"
    path.write_bytes(
        b"--- file type: CFG ---\r\n" + RECORD_2013.configuration().encode()
        + b"--- file type: DAT BINARY: 99 ---\r\n" + RECORD_2013.data()
    )  # fmt: skip
    assert mended(path, "found 90 bytes: read to the end of the file").samples.shape == (4, 5)


@pytest.mark.parametrize(
    "record",
    [
        RECORD_1999.but(rates=("1", "0,5")),
        RECORD_1999.but(identification="P,R,1066"),
        RECORD_1999.but(counts="7,4A,2D"),
        RECORD_1999.but(rates=("0", "0,5"), stamps=[0] * 5),
        RECORD_1999.but(rows=(), numbers=(), stamps=()),
        ASCII.but(rows=(), numbers=(), stamps=()),
    ],
)
def test_what_only_a_guess_could_mend_is_refused_all_the_same(tmp_path: Path, record: ComtradeFile) -> None:
    with pytest.raises(RecordingError):
        read(record.write(tmp_path), lenient=True)


def test_a_sound_file_has_nothing_repaired(tmp_path: Path) -> None:
    assert read(RECORD_1999.write(tmp_path), lenient=True).repairs == ()
