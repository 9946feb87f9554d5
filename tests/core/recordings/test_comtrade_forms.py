"""Sound records in forms that relays, converters and editors give them: the same values, and a warning."""

import codecs
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Recording, RecordingError, read
from tests.core.recordings.comtrade_files import (
    ANALOG_LINES,
    RECORD_1991,
    RECORD_1999,
    RECORD_2013,
    ROWS,
    ComtradeFile,
)

ASCII = RECORD_1999.but(data_format="ASCII")
MINUTE_NS = 60_000_000_000


def same(folder: Path, record: ComtradeFile, *warnings: str, sound: ComtradeFile = RECORD_1999) -> Recording:
    """The recording, read as the sound one is, with these warnings."""
    found = read(record.write(folder))
    expected = read(sound.write(folder, name="sound.cfg", data_name="sound.dat"))
    np.testing.assert_array_equal(found.samples, expected.samples)
    np.testing.assert_array_equal(found.time_s, expected.time_s)
    assert (found.start_time_ns, found.trigger_index) == (expected.start_time_ns, expected.trigger_index)
    assert found.repairs == ()
    assert len(found.warnings) == len(warnings), found.warnings
    for warning, words in zip(found.warnings, warnings, strict=True):
        assert words in warning, warning
        assert warning.startswith("record."), "the file is named"
    return found


@pytest.mark.parametrize(
    ("identification", "station", "device"),
    [
        ("PUMP HOUSE, MCC 7,RELAY 1,1999", "PUMP HOUSE, MCC 7", "RELAY 1"),
        ("A,B,C,RELAY 1,1999", "A,B,C", "RELAY 1"),
        ('"PUMP HOUSE, MCC 7",RELAY 1,1999', "PUMP HOUSE, MCC 7", "RELAY 1"),
        ('"PLANT","RELAY 1",1999', "PLANT", "RELAY 1"),
        ("PLANT,RELAY 1,1999,", "PLANT", "RELAY 1"),
    ],
)
def test_commas_and_quotes_in_the_names(
    tmp_path: Path, identification: str, station: str, device: str
) -> None:
    found = same(tmp_path, RECORD_1999.but(identification=identification), "line 1, ")
    assert (found.station, found.device) == (station, device)


def test_a_comma_in_a_name_of_1991(tmp_path: Path) -> None:
    record = RECORD_1991.but(identification="PUMP HOUSE, MCC 7,RELAY 1")
    found = same(tmp_path, record, "read as a name with commas", sound=RECORD_1991)
    assert (found.station, found.device) == ("PUMP HOUSE, MCC 7", "RELAY 1")


@pytest.mark.parametrize("edition", [RECORD_1991, RECORD_1999, RECORD_2013])
@pytest.mark.parametrize(
    ("written", "name"), [('"IA, pump 7"', "IA, pump 7"), ("IA, pump 7", "IA, pump 7"), ('"IA"', "IA")]
)
def test_commas_and_quotes_in_a_channel(
    tmp_path: Path, edition: ComtradeFile, written: str, name: str
) -> None:
    analog = (edition.analog[0].replace("IA", written, 1), *edition.analog[1:])
    found = same(tmp_path, edition.but(analog=analog), "analogue channel 1", sound=edition)
    assert found.channels[0].name == name
    assert (found.channels[0].phase, found.channels[0].unit) == ("a", "A")


def test_commas_in_a_state(tmp_path: Path) -> None:
    found = same(
        tmp_path, RECORD_1999.but(status=("1,TRIP, fast,,,0", "2,RB01,,,0,")), "channel 1", "channel 2"
    )
    assert found.digitals is not None
    assert found.digitals.names == ("TRIP, fast", "RB01")


def test_a_field_that_is_missing_is_no_comma(tmp_path: Path) -> None:
    """A line with too few fields, or with those of another kind of line, stays refused."""
    for behind in ("", ",P,x", ",P,1", ",x,P", ",1,P"):
        analog = ANALOG_LINES[0].replace(",P", behind)
        with pytest.raises(RecordingError, match="analogue channel 1"):
            read(RECORD_1999.but(analog=(analog, *ANALOG_LINES[1:])).write(tmp_path))


@pytest.mark.parametrize("line_end", ["\n", "\r", "\r\r\n"])
@pytest.mark.parametrize("record", [RECORD_1999, ASCII])
def test_line_ends(tmp_path: Path, record: ComtradeFile, line_end: str) -> None:
    doubled = line_end == "\r\r\n" and record is ASCII
    same(tmp_path, record.but(line_end=line_end), *(["blank lines"] if doubled else []))


@pytest.mark.parametrize("behind", [b"\r\n", b"\n", b"\x1a\r\n", b"\r\n\x1a"])
def test_line_ends_behind_binary_data(tmp_path: Path, behind: bytes) -> None:
    path = RECORD_1999.write(tmp_path)
    data = path.with_suffix(".dat")
    data.write_bytes(data.read_bytes() + behind)
    found = read(path)
    assert found.samples.shape == (4, 5)
    assert "line ends behind the last sample" in found.warnings[0]
    data.write_bytes(data.read_bytes() + b"\r\n0")
    with pytest.raises(RecordingError, match="size"):
        read(path)


ENCODINGS = {
    "utf-16-le with a mark": (codecs.BOM_UTF16_LE, "utf-16-le"),
    "utf-16-be with a mark": (codecs.BOM_UTF16_BE, "utf-16-be"),
    "utf-16-le": (b"", "utf-16-le"),
    "utf-16-be": (b"", "utf-16-be"),
    "utf-32": (codecs.BOM_UTF32_LE, "utf-32-le"),
}


@pytest.mark.parametrize(("mark", "encoding"), ENCODINGS.values(), ids=ENCODINGS)
@pytest.mark.parametrize("data_too", [False, True])
def test_wide_letters(tmp_path: Path, mark: bytes, encoding: str, *, data_too: bool) -> None:
    path = ASCII.write(tmp_path)
    sound = read(path)
    for file in [path, path.with_suffix(".dat")][: 1 + data_too]:
        file.write_bytes(mark + file.read_bytes().decode().encode(encoding))
    found = read(path)
    np.testing.assert_array_equal(found.samples, sound.samples)
    assert [channel.name for channel in found.channels] == [channel.name for channel in sound.channels]
    assert len(found.warnings) == 1 + data_too
    assert "the text is UTF-" in found.warnings[0]


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_wide_letters_of_another_alphabet(tmp_path: Path, encoding: str) -> None:
    path = RECORD_1999.but(identification="НАСОСНАЯ,RELAY 1,1999").write(tmp_path)
    path.write_bytes(path.read_bytes().decode().encode(encoding))
    assert read(path).station == "НАСОСНАЯ"


def test_a_mark_before_ascii_data(tmp_path: Path) -> None:
    path = ASCII.write(tmp_path)
    data = path.with_suffix(".dat")
    data.write_bytes(codecs.BOM_UTF8 + data.read_bytes())
    assert read(path).samples.shape == (4, 5)


def combined(data_format: str, line_end: str = "\r\n") -> bytes:
    record = RECORD_2013.but(data_format=data_format, line_end=line_end)
    data = record.data()
    size = "" if data_format == "ASCII" else f": {len(data)}"
    heads = (f"--- file type: CFG ---{line_end}", f"--- file type: DAT {data_format}{size} ---{line_end}")
    return heads[0].encode() + record.configuration().encode() + heads[1].encode() + data


@pytest.mark.parametrize("data_format", ["ASCII", "BINARY", "FLOAT32"])
@pytest.mark.parametrize("line_end", ["\r\n", "\n", "\r"])
def test_a_combined_file_with_a_byte_order_mark(tmp_path: Path, data_format: str, line_end: str) -> None:
    path = tmp_path / "record.cff"
    path.write_bytes(codecs.BOM_UTF8 + combined(data_format, line_end))
    assert read(path).samples.shape == (4, 5)


def test_a_combined_file_in_utf_16(tmp_path: Path) -> None:
    path = tmp_path / "record.cff"
    path.write_bytes(codecs.BOM_UTF16_LE + combined("ASCII").decode().encode("utf-16-le"))
    found = read(path)
    np.testing.assert_array_equal(found.samples, read(RECORD_2013.write(tmp_path)).samples)
    assert "UTF-16" in found.warnings[0]
    path.write_bytes(codecs.BOM_UTF16_LE + combined("BINARY").decode("latin-1").encode("utf-16-le"))
    with pytest.raises(RecordingError, match="as the file was saved as a text, found BINARY"):
        read(path)


@pytest.mark.parametrize(
    ("record", "rates"),
    [
        (RECORD_1999, ("2", "1000,2", "1000,3")),
        (RECORD_1999, ("2", "1000,3", "1000,2")),
        (ASCII, ("3", "1000,1", "1000,1", "1000,3")),
    ],
)
def test_numbers_of_samples_instead_of_last_samples(
    tmp_path: Path, record: ComtradeFile, rates: tuple[str, ...]
) -> None:
    same(tmp_path, record.but(rates=rates), "add up to the 5 in the data: read as counts")


def test_counts_of_two_rates_are_at_their_times(tmp_path: Path) -> None:
    record = RECORD_1999.but(rates=("2", "1000,3", "500,2"), stamps=(0, 1000, 2000, 4000, 6000))
    found = read(record.write(tmp_path))
    np.testing.assert_allclose(found.time_s, [0, 0.001, 0.002, 0.004, 0.006])


def test_last_samples_stay_last_samples(tmp_path: Path) -> None:
    found = same(tmp_path, RECORD_1999.but(rates=("2", "1000,2", "1000,5")))
    assert found.samples.shape == (4, 5)
    with pytest.raises(RecordingError, match="last sample"):
        read(RECORD_1999.but(rates=("2", "1000,4", "1000,2")).write(tmp_path))


MONTH_FIRST = ("11/21/2024,06:30:00.250000", "11/21/2024,06:30:00.252000")
DATES = {
    "ISO": ("2024-11-21,06:30:00.25", "2024-11-21,06:30:00.252"),
    "ISO with a T": ("2024-11-21T06:30:00.25", "2024-11-21T06:30:00.252"),
    "year first with slashes": ("2024/11/21,06:30:00.25", "2024/11/21,06:30:00.252"),
    "month first": MONTH_FIRST,
    "two digits": ("21/11/24,06:30:00.250", "21/11/24,06:30:00.252"),
    "dashes": ("21-11-2024,06:30:00.25", "21-11-2024,06:30:00.252"),
    "points": ("21.11.2024,06:30:00.25", "21.11.2024,06:30:00.252"),
    "month in letters": ("21-Nov-2024,06:30:00.25", "21-NOV-2024,06:30:00.252"),
    "decimal comma": ("21/11/2024,06:30:00,25", "21/11/2024,06:30:00,252"),
    "spaces": ("21/11/2024, 6:30: 0.250000", " 21/ 11/2024 ,06: 30:00.252000"),
    "one field": ("21/11/2024 06:30:00.250000", "21/11/2024 06:30:00.252000"),
    "month in a word": ("21 November 2024,06:30:00.25", "Nov 21, 2024 06:30:00.252"),
    "year first, then the day": ("2024-21-11,06:30:00.25", "2024-21-11,06:30:00.252"),
    "quotes": ('"21/11/2024",06:30:00.25', '"21/11/2024,06:30:00.252"'),
    "other signs between": ("21/11/2024;06:30:00:25", "21/11/2024,06:30:00:252"),
    "before noon": ("21/11/2024,06:30:00.25 AM", "21/11/2024,6:30:00.252am"),
    "commas behind": ("21/11/2024,06:30:00.250000,,", "21/11/2024,06:30:00.252000,"),
}


@pytest.mark.parametrize(("start", "trigger"), DATES.values(), ids=DATES)
def test_dates_that_can_be_read_one_way_only(tmp_path: Path, start: str, trigger: str) -> None:
    note = "read as 2024-11-21 06:30:00"
    same(tmp_path, RECORD_1999.but(start=start, trigger=trigger), note, note)


def test_after_noon(tmp_path: Path) -> None:
    record = RECORD_1999.but(start="21/11/2024,12:00:00.25 PM", trigger="21/11/2024,12:00:00.252 PM")
    assert "read as 2024-11-21 12:00:00" in read(record.write(tmp_path)).warnings[0]
    with pytest.raises(RecordingError, match="hour: expected 1 to 12 before PM"):
        read(record.but(start="21/11/2024,13:00:00.25 PM").write(tmp_path))


def test_a_date_that_says_it_is_utc(tmp_path: Path) -> None:
    """A plant whose relays run in local time does not move it."""
    dates = {"start": "2024-11-21T06:30:00.25Z", "trigger": "2024-11-21T06:30:00.252Z"}
    found = read(RECORD_1999.but(**dates).write(tmp_path))
    assert found.has_time_code
    assert found.start_time_ns == read(RECORD_1999.write(tmp_path)).start_time_ns
    with pytest.raises(RecordingError, match="time of the first sample"):
        read(RECORD_2013.but(**dates).write(tmp_path))


def test_day_first_in_1991(tmp_path: Path) -> None:
    record = RECORD_1991.but(start="21/11/2024,06:30:00.25", trigger="21/11/2024,06:30:00.252")
    same(tmp_path, record, "read as 2024-11-21", "read as 2024-11-21", sound=RECORD_1991)


def test_two_dates_of_one_file_are_in_one_order(tmp_path: Path) -> None:
    """31/01 can be read one way only, so that 01/02 of the same file is the first of February."""
    record = RECORD_1991.but(start="31/01/2024,23:59:59.999", trigger="01/02/2024,00:00:00.001")
    found = read(record.write(tmp_path))
    assert found.trigger_index == 2
    assert found.start_time_ns == 1_706_745_599_999_000_000


def test_what_the_edition_says_holds_where_both_orders_are_dates(tmp_path: Path) -> None:
    dates = {"start": "05/01/2026,09:00:00.000000", "trigger": "05/01/2026,09:00:00.002000"}
    assert read(RECORD_1999.but(**dates).write(tmp_path)).start_time_ns == 1_767_603_600_000_000_000
    assert read(RECORD_1991.but(**dates).write(tmp_path)).start_time_ns == 1_777_626_000_000_000_000


@pytest.mark.parametrize(
    ("code", "minutes"),
    [("+5h", 300), ("-5h", -300), ("+05:30", 330), ("UTC+1", 60), ("+0530", 330), ("UTC", 0), ("Z", 0),
     ("5h30m", 330), ("+5.5", 330), ("-3.25", -195)],
)  # fmt: skip
def test_time_codes(tmp_path: Path, code: str, minutes: int) -> None:
    found = read(RECORD_2013.but(tail=("1", f"{code},{code}", "0,0")).write(tmp_path))
    assert found.start_time_ns == read(RECORD_1999.write(tmp_path)).first_time_ns - minutes * MINUTE_NS
    assert found.has_time_code
    assert "read as" in found.warnings[0]


@pytest.mark.parametrize("behind", [",", ",,", ", "])
def test_lines_that_end_in_commas(tmp_path: Path, behind: str) -> None:
    path = ASCII.write(tmp_path)
    sound = read(path)
    data = path.with_suffix(".dat")
    data.write_bytes(data.read_bytes().replace(b"\r\n", behind.encode() + b"\r\n"))
    found = read(path)
    np.testing.assert_array_equal(found.samples, sound.samples)
    (warning,) = found.warnings
    assert "record.dat: lines end in a comma" in warning
    data.write_bytes(ASCII.data().replace(b"\r\n", b",7\r\n"))
    with pytest.raises(RecordingError, match="fields"):
        read(path)


def test_signed_counts_of_1991_have_no_mark(tmp_path: Path) -> None:
    """A count of -1 has the bits of 0xFFFF: where the limits have a sign, it is a value."""
    rows = [(-1, -1, -1, -1), *ROWS[1:]]
    lines = [line.replace("-32767,32767", "0,4095") if "IC" in line else line for line in RECORD_1991.analog]
    found = read(RECORD_1991.but(rows=rows, analog=tuple(lines)).write(tmp_path))
    np.testing.assert_allclose(found.samples[:, 0], [-0.01, -0.01, np.nan, 499.9])
    text = read(RECORD_1991.but(rows=rows, data_format="ASCII").write(tmp_path, data_name="record.dat"))
    np.testing.assert_array_equal(text.samples[[0, 1, 3]], found.samples[[0, 1, 3]])


def long(stamps: list[int]) -> ComtradeFile:
    count = len(stamps)
    return RECORD_1999.but(
        rates=("1", f"1000,{count}"),
        rows=[(k, -k, 0, 1) for k in range(count)],
        numbers=range(1, count + 1),
        stamps=stamps,
    )


@pytest.mark.parametrize("order", ["back, then gap", "gap, then back"])
def test_a_gap_beside_a_step_back_is_kept(tmp_path: Path, order: str) -> None:
    moves = {20: -7_000, 40: 170_000} if order.startswith("back") else {20: 170_000, 40: -7_000}
    stamps, late = [], 100_000
    for k in range(60):
        late += moves.get(k, 0)
        stamps.append(late + k * 1000)
    for lenient in (False, True):
        found = read(long(stamps).write(tmp_path), lenient=lenient)
        assert found.repairs == ()
        (warning,) = found.warnings
        assert "the gaps are kept" in warning
        steps = np.diff(found.time_s)
        at = {k - 1: (0.171 if move > 0 else 0.002) for k, move in moves.items()}
        np.testing.assert_allclose(steps, [at.get(k, 0.001) for k in range(59)], atol=1e-6)


def test_stamps_that_are_wrong_for_a_while_tell_no_gap(tmp_path: Path) -> None:
    stamps = [k * 1000 - (50_000 if 20 <= k < 30 else 0) + 100_000 for k in range(60)]
    path = long(stamps).write(tmp_path)
    with pytest.raises(RecordingError, match="time stamp"):
        read(path)
    assert "the time stamps are ignored" in read(path, lenient=True).repairs[0]
