"""A file that contradicts itself is refused, and the message says where; nothing is filled in."""

import pickle
from pathlib import Path

import pytest

from core.recordings import RecordingError, read
from core.recordings.data_section import DataSection
from tests.core.recordings.comtrade_files import (
    ANALOG_LINES,
    RECORD_1991,
    RECORD_1999,
    RECORD_2013,
    ComtradeFile,
)

SOUND = RECORD_1999
ASCII = SOUND.but(data_format="ASCII")


def analog(old: str, new: str) -> tuple[str, ...]:
    assert old in ANALOG_LINES[1]
    return (ANALOG_LINES[0], ANALOG_LINES[1].replace(old, new), *ANALOG_LINES[2:])


CONFIGURATIONS: dict[str, tuple[ComtradeFile, str]] = {
    "unknown revision": (SOUND.but(identification="P,R,2024"), "line 1, .*revision: expected one of 1991"),
    "identification of one field": (SOUND.but(identification="P"), "line 1, .*expected 2 or 3 fields"),
    "total is no sum": (SOUND.but(counts="7,4A,2D"), "line 2, channel counts, total: .*4 \\+ 2 = 6"),
    "count without letter": (SOUND.but(counts="6,4,2D"), "line 2, .*a count followed by A, found '4'"),
    "more channels than lines": (SOUND.but(counts="106,104A,2D"), "at most the file's"),
    "one line too many": (SOUND.but(counts="5,3A,2D"), "line 6, status channel 1.*5 fields, found 13"),
    "one line too few": (SOUND.but(counts="7,5A,2D"), "line 7, analogue channel 5.*13 fields, found 5"),
    "no analogue channel": (SOUND.but(counts="2,0A,2D", analog=()), "at least one, found none"),
    "index out of order": (SOUND.but(analog=analog("2,IB", "3,IB")), "line 4, .*from 2 to 2, found '3'"),
    "constant value in unknown volts": (
        SOUND.but(analog=analog("0.01,0,0,-32767,32767,100,5,P", "0,7,0,0,0,0,5,S")),
        "transformer ratio: .*found 0:5",
    ),
    "multiplier not finite": (SOUND.but(analog=analog("0.01", "1e999")), "multiplier a: expected a finite"),
    "multiplier nan": (SOUND.but(analog=analog("0.01", "nan")), "multiplier a: .*found 'nan'"),
    "multiplier with underscore": (SOUND.but(analog=analog("0.01", "1_0")), "multiplier a: .*'1_0'"),
    "offset no number": (SOUND.but(analog=analog("0.01,0,", "0.01,,")), "offset b: expected a finite"),
    "values overflow": (SOUND.but(analog=analog("0.01", "1e308")), "channel 'IB': .*too large"),
    "limits swapped": (SOUND.but(analog=analog("-32767,32767", "1,-1")), "minimum: expected at most"),
    "neither P nor S": (SOUND.but(analog=analog(",P", ",X")), "PS: expected P or S, found 'X'"),
    "ratio of zero": (SOUND.but(analog=analog("100,5,P", "0,5,S")), "transformer ratio: .*found 0:5"),
    "ratio by zero": (SOUND.but(analog=analog("100,5,P", "100,0,S")), "transformer ratio: .*found 100:0"),
    "absurd ratio": (SOUND.but(analog=analog("100,5,P", "1e200,1e-200,S")), "ratio below 1e12"),
    "skew of a sample": (
        SOUND.but(analog=analog(",0,0,-", ",0,-1000,-")),
        "channel 'IB', skew: expected less than a sample period, 1000 us, .*found -1000 us",
    ),
    "normal state": (SOUND.but(status=("1,T,,,2", "2,R,,,0")), "normal state: expected 0 or 1, found '2'"),
    "line frequency": (SOUND.but(frequency="-50"), "line frequency: expected"),
    "rates in disorder": (
        SOUND.but(rates=("2", "1000,5", "500,3")),
        "rate 2 and last sample, last sample: .*6",
    ),
    "fewer rates than announced": (SOUND.but(rates=("2", "1000,5")), "rate 2 and last sample, last sample"),
    "more rates than announced": (SOUND.but(rates=("1", "1000,3", "500,5")), "first sample: expected dd/mm"),
    "a thousand rates": (SOUND.but(rates=("1000", "1000,5")), "number of sampling rates: .*from 0 to 999"),
    "second rate of zero": (SOUND.but(rates=("2", "1000,3", "0,5")), "rate 2 .*sampling rate .*found '0'"),
    "rate of zero": (SOUND.but(rates=("1", "0,5")), "sampling rate .*found '0'"),
    "rate without rates": (SOUND.but(rates=("0", "1000,5")), "0, as the file announces 0 rates"),
    "no sample": (SOUND.but(rates=("1", "1000,0"), rows=(), numbers=(), stamps=()), "last sample"),
    "negative samples": (SOUND.but(rates=("1", "1000,-5")), "last sample: .*found '-5'"),
    "american date": (SOUND.but(start="11/21/2024,06:30:00.25"), "line 12, time of the first sample.*month"),
    "no such day": (SOUND.but(start="31/02/2024,06:30:00.25"), "a date and time, dd/mm/yyyy"),
    "year of three digits": (SOUND.but(start="21/11/024,06:30:00.25"), "year: expected two or four digits"),
    "year fifteen": (SOUND.but(start="21/11/0015,06:30:00.25"), "year: expected 1970 to 2200, found 15"),
    "no time": (SOUND.but(trigger=","), "time of the trigger: expected dd/mm/yyyy"),
    "trigger before the record": (SOUND.but(trigger="21/11/2024,06:29:59.0"), "trigger: .*-1.25"),
    "trigger after the record": (SOUND.but(trigger="21/11/2024,06:30:00.256"), "trigger: .*0 to 0.005 s"),
    "european date in 1991": (RECORD_1991.but(start="21/11/24,06:30:00.25"), "mm/dd/yy.*month"),
    "time multiplier of zero": (SOUND.but(tail=("0",)), "time multiplier: expected a number from"),
    "no time multiplier": (SOUND.but(tail=()), "line 15: expected time multiplier, found the end"),
    "2013 without time code": (
        RECORD_2013.but(tail=("1",)),
        "expected time code and local code, found the end",
    ),
    "2013 lines in a 1999 file": (SOUND.but(tail=("1", "0,0", "0,0")), "nothing more in a file of rev"),
    "time code": (RECORD_2013.but(tail=("1", "CET,0", "0,0")), "time code: .*found 'CET'"),
    "time code out of range": (RECORD_2013.but(tail=("1", "15,0", "0,0")), "time code: .*found '15'"),
    "local code": (RECORD_2013.but(tail=("1", "0,CET", "0,0")), "local code: .*found 'CET'"),
    "time quality": (RECORD_2013.but(tail=("1", "0,0", "G,0")), "time quality: expected a hexadecimal"),
    "leap second": (RECORD_2013.but(tail=("1", "0,0", "0,4")), "leap second: .*found '4'"),
    "control character": (SOUND.but(identification="P\x1b[31m,R,1999"), "no control characters"),
}

DATA: dict[str, tuple[ComtradeFile, str]] = {
    "sample lost": (SOUND.but(rates=("1", "1000,6")), r"\.dat: size: expected 108 bytes: 6 samples of 18"),
    "sample too many": (SOUND.but(rates=("1", "1000,4")), r"\.dat: size: expected 72 bytes.*found 90"),
    "ascii sample lost": (ASCII.but(rates=("1", "1000,6")), "size: expected 6 lines, one a sample, found 5"),
    "numbers with a gap": (SOUND.but(numbers=(1, 2, 4, 5, 6)), "sample 3, number: expected 3, .*found 4"),
    "numbers twice": (ASCII.but(numbers=(1, 2, 2, 3, 4)), "sample 3, number: expected 3, .*found 2"),
    "head cut off": (SOUND.but(numbers=range(3, 8)), "sample 1, number: expected 1, found 3"),
    "time stamps of half the rate": (
        SOUND.but(stamps=(0, 2000, 4000, 6000, 8000)),
        "sample 2, time stamp: expected 1 ms .*found 2 ms",
    ),
    "time stamps overlap": (
        SOUND.but(stamps=(0, 1000, 2000, 1500, 2500)),
        "sample 4, time stamp: expected 3 ms .*found 1.5 ms",
    ),
    "time stamps back": (ASCII.but(stamps=(0, 1000, 500, 3000, 4000)), "sample 3, time stamp"),
    "time stamps of another rate": (
        SOUND.but(stamps=(0, 500, 1000, 1500, 2000)),
        "sample 3, .*1000 Hz gives, or a gap after it, found 1 ms",
    ),
    "no rate and a stamp missing": (
        SOUND.but(rates=("0", "0,5"), stamps=(0, 1000, None, 3000, 4000)),
        "increasing ones .*1 missing",
    ),
    "no rate and no time": (SOUND.but(rates=("0", "0,5"), stamps=[0] * 5), "found none that increase"),
    "no rate and time stamps back": (
        SOUND.but(rates=("0", "0,5"), stamps=(0, 1000, 2000, 1500, 3000)),
        "none that increase",
    ),
    "absurd time stamp": (ASCII.but(stamps=(0, 1000, 10**14, 3000, 4000)), "sample 3, time stamp: .*1e\\+13"),
    "value infinite": (
        RECORD_2013.but(data_format="FLOAT32", rows=[(0, 0, float("inf"), 0)] * 5),
        "sample 1, analogue channel 3",
    ),
    "ascii infinite": (ASCII.but(rows=[(0, 0, float("inf"), 0)] * 5), "line 1, field 5: expected a number"),
    "ascii nan": (ASCII.but(rows=[(0, 0, float("nan"), 0)] * 5), "line 1, field 5: expected a number"),
}


@pytest.mark.parametrize(("record", "reason"), CONFIGURATIONS.values(), ids=CONFIGURATIONS)
def test_configuration_refused(tmp_path: Path, record: ComtradeFile, reason: str) -> None:
    with pytest.raises(RecordingError, match=f"^record.cfg: .*{reason}"):
        read(record.write(tmp_path))


@pytest.mark.parametrize(("record", "reason"), DATA.values(), ids=DATA)
def test_data_refused(tmp_path: Path, record: ComtradeFile, reason: str) -> None:
    with pytest.raises(RecordingError, match=reason) as refused:
        read(record.write(tmp_path))
    assert refused.value.path == tmp_path / "record.dat"


def test_unknown_data_format(tmp_path: Path) -> None:
    path = RECORD_1999.write(tmp_path)
    path.write_bytes(path.read_bytes().replace(b"BINARY", b"BINARY64"))
    with pytest.raises(RecordingError, match="one of ASCII, BINARY, BINARY32, FLOAT32, found 'BINARY64'"):
        read(path)


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (b"1500", b"1 500", "line 3, field 4: expected a number .*'1 500'"),
        (b"1500", b"15,00", "line 3: expected 8 fields: number, time stamp, 4 analogue and 2 status .*9"),
        (b"1500", b"1" * 40, "line 3, field 4: expected a number of at most 32 characters"),
        (b"1500", b"1e999", "sample 3, analogue channel 2: expected a finite value"),
        (b"1500", b"1-5", "line 3, field 4: .*'1-5'"),
        (b"1500", b"\x001500", "line 3, field 4"),
        (b"1500", b"15\xb200", "line 3, field 4"),
        (b"1500", b"\x0c1500", "text: expected numbers, commas and line ends"),
        (b"\r\n2,", b"\r\n1,2\r\n2,", "expected 5 lines, one a sample, found 6"),
        (b"-2000,1500,500,6,0,1", b"-2000,1500,500,6,0,2", "line 3, field 8: expected a status of 0 or 1"),
        (b"-2000,1500,500,6,0,1", b"-2000,1500,500,6,0,", "line 3, field 8: expected a status"),
        (b"3,2000", b",2000", "sample 3, number: expected 3"),
        (b"3,2000", b"3.5,2000", "sample 3, number: expected 3, .*found 3.5"),
    ],
)
def test_ascii_data_refused(tmp_path: Path, old: bytes, new: bytes, reason: str) -> None:
    path = ASCII.write(tmp_path)
    data = path.with_suffix(".dat")
    assert old in data.read_bytes()
    data.write_bytes(data.read_bytes().replace(old, new))
    with pytest.raises(RecordingError, match=reason):
        read(path)


@pytest.mark.parametrize("data_format", ["ASCII", "BINARY", "BINARY32", "FLOAT32"])
def test_every_truncation_is_noticed(tmp_path: Path, data_format: str) -> None:
    path = RECORD_2013.but(data_format=data_format).write(tmp_path)
    data = path.with_suffix(".dat").read_bytes()
    # An ASCII file loses nothing with its last line end.
    for length in range(len(data) - (2 if data_format == "ASCII" else 0)):
        path.with_suffix(".dat").write_bytes(data[:length])
        with pytest.raises(RecordingError):
            read(path)


def test_every_truncation_of_the_configuration_is_noticed(tmp_path: Path) -> None:
    record = RECORD_2013.but(tail=("1", "0,0", "0,0"))
    path = record.write(tmp_path)
    text = record.configuration().rstrip()
    for length in range(len(text)):
        path.write_text(text[:length])
        with pytest.raises(RecordingError):
            read(path)


def test_data_after_the_last_sample_are_refused(tmp_path: Path) -> None:
    path = RECORD_1999.write(tmp_path)
    data = path.with_suffix(".dat")
    data.write_bytes(data.read_bytes() + b"\x00")
    with pytest.raises(RecordingError, match=r"expected 90 bytes.*found 91"):
        read(path)


def test_a_file_that_is_cut_while_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = SOUND.write(tmp_path)

    def cut(section: DataSection, start: int, padding: bytes) -> bool:
        section.path.write_bytes(SOUND.data()[: start - 20])
        return True

    monkeypatch.setattr(DataSection, "is_padding_after", cut)
    with pytest.raises(RecordingError, match=r"record.dat: size: expected 90 bytes as before, found fewer"):
        read(path)


def test_missing_files(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"r.cfg: file: expected a file, found none"):
        read(tmp_path / "r.cfg")
    (tmp_path / "r.cfg").write_text(RECORD_1999.configuration())
    with pytest.raises(RecordingError, match=r"data file: expected one r.dat in the same folder, found none"):
        read(tmp_path / "r.cfg")
    for name in ("r.DAT", "R.dat"):
        (tmp_path / name).write_bytes(RECORD_1999.data())
    with pytest.raises(RecordingError, match=r"found R.dat, r.DAT"):
        read(tmp_path / "r.cfg")


@pytest.mark.parametrize("name", ["record.wav", "record", "record.dat"])
def test_other_files(tmp_path: Path, name: str) -> None:
    with pytest.raises(RecordingError, match=r"file name suffix: expected one of .cfg"):
        read(tmp_path / name)


def test_a_huge_configuration_is_not_even_read(tmp_path: Path) -> None:
    path = tmp_path / "r.cfg"
    with path.open("wb") as file:
        file.truncate(17 << 20)
    with pytest.raises(RecordingError, match="size: expected at most"):
        read(path)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "expected a CFG and a DAT section, found neither"),
        (b"--- file type: CFG ---\r\n{cfg}", "found no DAT"),
        (b"--- file type: DAT BINARY: 90 ---\r\n{dat}", "expected CFG before DAT"),
        (b"--- file type: CFG ---\r\n{cfg}--- file type: CFG ---\r\n{cfg}", "expected one CFG, found two"),
        (
            b"--- file type: CFG ---\r\n{cfg}--- file type: DAT BINARY: 91 ---\r\n{dat}",
            "91 bytes after '--- file",
        ),
        (b"--- file type: CFG ---\r\n{cfg}--- file type: DAT BINARY: 89 ---\r\n{dat}", "found 90 bytes"),
        (
            b"--- file type: CFG ---\r\n{cfg}--- file type: DAT ASCII ---\r\n{dat}",
            "format BINARY, found 'ASCII'",
        ),
        (b"--- file type: CFG ---\r\n{cfg}--- file type: DAT ---\r\n{dat}", "format BINARY, found ''"),
    ],
)
def test_combined_file_refused(tmp_path: Path, content: bytes, reason: str) -> None:
    path = tmp_path / "record.cff"
    content = content.replace(b"{cfg}", RECORD_2013.configuration().encode())
    path.write_bytes(content.replace(b"{dat}", RECORD_2013.data()))
    with pytest.raises(RecordingError, match=reason):
        read(path)


def test_the_error_survives_the_way_back_from_a_worker_process(tmp_path: Path) -> None:
    with pytest.raises(RecordingError) as refused:
        read(tmp_path / "r.cfg")
    copy = pickle.loads(pickle.dumps(refused.value))  # noqa: S301 - our own bytes
    assert str(copy) == str(refused.value)
    assert (copy.path, copy.field) == (tmp_path / "r.cfg", "file")
