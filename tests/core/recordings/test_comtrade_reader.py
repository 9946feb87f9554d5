"""What the reader delivers of sound files, checked against values computed by hand."""

from datetime import UTC, datetime
from math import nan
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Quantity, Recording, read
from core.units import NANOSECONDS_PER_SECOND
from tests.core.recordings.comtrade_files import (
    ANALOG_LINES,
    RECORD_1991,
    RECORD_1999,
    RECORD_2013,
    ComtradeFile,
    unsigned,
)

START_NS = int(datetime(2024, 11, 21, 6, 30, tzinfo=UTC).timestamp()) * NANOSECONDS_PER_SECOND + 250_000_000
EXPECTED = np.array(
    [
        [0, 10, -20, 30, 0.01],
        [1, -5, 15, -30, 0.02],
        [-1, -5, 5, 0, 0.03],
        [500.4, 500.5, 500.6, 499.3, 500.8],
    ]
)


def check(recording: Recording) -> None:
    np.testing.assert_allclose(recording.samples, EXPECTED, rtol=1e-12)
    assert recording.samples.flags.c_contiguous
    assert recording.sample_rate_hz == 1000
    assert recording.start_time_ns == START_NS
    assert recording.trigger_index == 2
    assert recording.trigger_time_ns == START_NS + 2_000_000
    assert recording.nominal_frequency_hz == 50
    assert (recording.station, recording.device) == ("PLANT", "RELAY 1")
    assert [c.name for c in recording.channels] == ["IA", "IB", "IC", "VAB"]
    assert [c.phase for c in recording.channels] == ["a", "b", "c", "ab"]
    assert [c.unit for c in recording.channels] == ["A", "A", "A", "V"]
    assert recording.channels[3].quantity is Quantity.LINE_VOLTAGE
    assert recording.channels[0].full_scale == pytest.approx(327.67)
    assert recording.channels[3].full_scale == pytest.approx(3776.7)


@pytest.mark.parametrize("line_end", ["\r\n", "\n"])
@pytest.mark.parametrize(
    ("record", "data_format"),
    [
        *((RECORD_1999, f) for f in ("ASCII", "BINARY", "binary")),
        *((RECORD_1991, f) for f in ("ASCII", "BINARY")),
        *((RECORD_2013, f) for f in ("ASCII", "BINARY", "BINARY32", "FLOAT32")),
    ],
    ids=lambda value: value if isinstance(value, str) else value.identification[-4:],
)
def test_every_edition_and_format(
    tmp_path: Path, record: ComtradeFile, data_format: str, line_end: str
) -> None:
    record = record.but(data_format=data_format.upper(), line_end=line_end)
    path = record.write(tmp_path)
    if data_format != data_format.upper():
        path.write_bytes(record.but(data_format=data_format).configuration().encode())
    check(read(path))


def test_a_combined_file(tmp_path: Path) -> None:
    path = tmp_path / "record.CFF"
    for data_format, heading in (("ASCII", "ASCII"), ("BINARY", "BINARY: 90"), ("FLOAT32", "FLOAT32: 130")):
        record = RECORD_2013.but(data_format=data_format)
        path.write_bytes(
            b"--- file type: CFG ---\r\n" + record.configuration().encode()
            + b"--- file type: INF ---\r\n\r\n--- file type: HDR ---\r\nhello\r\n"
            + f"--- file type: DAT {heading} ---\r\n".encode() + record.data()
        )  # fmt: skip
        check(read(path))


@pytest.mark.parametrize(
    ("name", "data_name"),
    [("r.cfg", "r.DAT"), ("R.CFG", "r.dat"), ("R.CFG", "R.DAT"), ("r.Cfg", "R.dAT")],
)
def test_the_data_file_is_found_in_any_case(tmp_path: Path, name: str, data_name: str) -> None:
    RECORD_1999.write(tmp_path, data_name="other.dat")
    check(read(RECORD_1999.write(tmp_path, name=name, data_name=data_name)))


def test_of_two_data_files_the_one_spelt_alike_is_taken(tmp_path: Path) -> None:
    path = RECORD_1999.write(tmp_path, name="r.cfg", data_name="r.dat")
    (tmp_path / "r.DAT").write_bytes(b"")
    check(read(path))


@pytest.mark.parametrize("padding", [b"\x1a", b"\x1a" * 100])
@pytest.mark.parametrize("data_format", ["ASCII", "BINARY"])
def test_padding_at_the_end_is_no_data(tmp_path: Path, padding: bytes, data_format: str) -> None:
    path = RECORD_1999.but(data_format=data_format).write(tmp_path)
    for file in (path, path.with_suffix(".dat")):
        file.write_bytes(file.read_bytes() + padding)
    check(read(path))


def test_secondary_values_are_brought_to_the_primary_side(tmp_path: Path) -> None:
    analog = ("1,IA,A,,A,0.01,0.1,0,-1000,1000,100,5,S", "2,UA,A,,V,0.1,0,0,-1000,1000,6000,100,s")
    record = read(
        RECORD_1999.but(counts="4,2A,2D", analog=analog, rows=[(k, k) for k in range(5)]).write(tmp_path)
    )
    np.testing.assert_allclose(record.samples[0], [2, 2.2, 2.4, 2.6, 2.8])
    np.testing.assert_allclose(record.samples[1], [0, 6, 12, 18, 24])
    assert [c.full_scale for c in record.channels] == pytest.approx([202, 6000])


@pytest.mark.parametrize(
    ("record", "marker"),
    [
        (RECORD_1991.but(analog=unsigned(RECORD_1991.analog)), -1),
        (RECORD_1999, -0x8000),
        (RECORD_1999.but(data_format="ASCII"), 99999),
        (RECORD_2013.but(data_format="ASCII"), 99999),
        (RECORD_2013.but(data_format="BINARY32"), -0x80000000),
        (RECORD_2013.but(data_format="FLOAT32"), nan),
        (RECORD_2013.but(data_format="FLOAT32"), -3.4028234663852886e38),
    ],
)
def test_missing_samples_are_nan(tmp_path: Path, record: ComtradeFile, marker: float) -> None:
    rows = [list(row) for row in record.rows]
    rows[3][1] = marker
    samples = read(record.but(rows=rows).write(tmp_path)).samples
    expected = EXPECTED.copy()
    expected[1, 3] = nan
    np.testing.assert_allclose(samples, expected)


def test_a_blank_value_is_missing(tmp_path: Path) -> None:
    path = RECORD_1991.but(data_format="ASCII").write(tmp_path)
    data = path.with_suffix(".dat")
    data.write_bytes(data.read_bytes().replace(b"-500", b"", 1))
    assert np.argwhere(np.isnan(read(path).samples)).tolist() == [[1, 1]]


def test_names_are_utf_8_or_else_latin_1(tmp_path: Path) -> None:
    path = RECORD_1999.but(identification="Estação,Relé,1999").write(tmp_path)
    assert read(path).station == "Estação"
    path.write_bytes(path.read_bytes().decode().encode("latin-1"))
    assert read(path).station == "Estação"
    path.write_bytes(b"\xef\xbb\xbf" + RECORD_1999.configuration().encode())
    check(read(path))


def test_a_letter_of_another_code_page_ends_no_line(tmp_path: Path) -> None:
    path = RECORD_1999.write(tmp_path)
    path.write_bytes(path.read_bytes().replace(b"PLANT", b"\x85\xd1\xd8"))
    assert read(path).samples == pytest.approx(EXPECTED)


@pytest.mark.parametrize(
    ("time_code", "hours"), [("0", 0), ("+2", 2), ("2", 2), ("-5h30", -5.5), ("5h45", 5.75), ("-0h30", -0.5)]
)
def test_the_2013_time_code_leads_to_utc(tmp_path: Path, time_code: str, hours: float) -> None:
    recording = read(RECORD_2013.but(tail=("1", f"{time_code},x", "A,3")).write(tmp_path))
    assert recording.start_time_ns == START_NS - round(hours * 3600e9)
    assert recording.trigger_index == 2


def test_nanoseconds_of_2013(tmp_path: Path) -> None:
    record = RECORD_2013.but(
        start="21/11/2024,06:30:00.250000001",
        trigger="21/11/2024,06:30:00.252000001",
        stamps=[k * 1_000_000 for k in range(5)],
    )
    assert read(record.write(tmp_path)).start_time_ns == START_NS + 1


@pytest.mark.parametrize(("year", "century"), [("69", 2069), ("70", 1970), ("99", 1999), ("2007", 2007)])
def test_years_of_1991(tmp_path: Path, year: str, century: int) -> None:
    record = RECORD_1991.but(start=f"11/21/{year},00:00:00.0", trigger=f"11/21/{year},00:00:00.0")
    start_s = datetime(century, 11, 21, tzinfo=UTC).timestamp()
    assert read(record.write(tmp_path)).start_time_ns == start_s * NANOSECONDS_PER_SECOND


@pytest.mark.parametrize(
    "changes",
    [
        {"stamps": [None] * 5},
        {"stamps": [0, None, 2000, None, 4000]},
        {"stamps": [0] * 5},
        {"stamps": [72_500 + 1000 * k for k in range(5)]},
        {"stamps": [0, 1001, 1999, 3000, 4004]},
        {"stamps": [0, 1, 2, 3, 4], "tail": ("1000",)},
        {"stamps": [0, 20, 40, 60, 80], "tail": ("50.0",)},
        {"numbers": range(5)},
        {"rates": ("0", "0,5")},
        {"frequency": "50.0"},
        {"rates": ("1", "1000.000000,00005")},
        {"status": ("1,TRIP,,,", "2,RB01,,,1")},
        {"identification": "PLANT,RELAY 1,2001"},
        {"identification": "PLANT,RELAY 1,1997"},
        {"counts": " 6, 4a, 2d"},
    ],
    ids=str,
)
@pytest.mark.parametrize("data_format", ["ASCII", "BINARY"])
def test_what_the_standard_leaves_open_is_read(
    tmp_path: Path, changes: dict[str, object], data_format: str
) -> None:
    check(read(RECORD_1999.but(data_format=data_format, **changes).write(tmp_path)))


def test_the_time_stamps_give_the_rate_where_the_configuration_names_none(tmp_path: Path) -> None:
    record = RECORD_1999.but(rates=("0", "0,5"), stamps=[0, 1249, 2498, 3748, 4997])
    assert read(record.write(tmp_path)).sample_rate_hz == pytest.approx(4 / 4997e-6)


def test_time_stamps_of_16_bits_start_again(tmp_path: Path) -> None:
    count = 100
    record = RECORD_1999.but(
        rates=("1", f"1000,{count}"),
        rows=[(0, 0, 0, 0)] * count,
        numbers=range(1, count + 1),
        stamps=[1000 * k % 65536 for k in range(count)],
    )
    assert read(record.write(tmp_path)).samples.shape == (4, count)


@pytest.mark.parametrize("frequency", ["", "0"])
def test_an_unknown_line_frequency_is_none(tmp_path: Path, frequency: str) -> None:
    assert read(RECORD_1999.but(frequency=frequency).write(tmp_path)).nominal_frequency_hz is None


def test_limits_that_say_nothing_give_no_full_scale(tmp_path: Path) -> None:
    analog = tuple(line.replace("-32767,32767", "0,0") for line in ANALOG_LINES)
    assert {c.full_scale for c in read(RECORD_1999.but(analog=analog).write(tmp_path)).channels} == {None}


def test_more_than_sixteen_status_channels_and_none(tmp_path: Path) -> None:
    many = RECORD_1999.but(counts="21,4A,17D", status=tuple(f"{k},S{k},,,0" for k in range(1, 18)))
    check(read(many.write(tmp_path)))
    check(read(RECORD_1999.but(counts="4,4A,0D", status=()).write(tmp_path)))


def test_channels_sampled_one_after_another_are_brought_to_one_instant(tmp_path: Path) -> None:
    skews_us = (0.0, 20.0, -40.0, 300.0)
    analog = tuple(
        f"{k},{name},,,A,0.001,0,{skew:g},-32767,32767,1,1,P"
        for k, (name, skew) in enumerate(zip(("IA", "IB", "IC", "Aux"), skews_us, strict=True), 1)
    )
    t_us = np.arange(100) * 1000
    angles = 2 * np.pi * 50e-6 * (t_us + np.array([skews_us]).T)
    record = RECORD_1999.but(
        analog=(*analog[:3], analog[3].replace(",A,", ",rpm,")),
        rates=("1", "1000,100"),
        rows=np.rint(20_000 * np.cos(angles)).astype(int).T.tolist(),
        numbers=range(1, 101),
        stamps=t_us.tolist(),
    )
    samples = read(record.write(tmp_path)).samples
    expected = 20 * np.cos(angles[0])
    assert samples[:3] == pytest.approx(np.array([expected] * 3), abs=0.002)
    assert samples[3] == pytest.approx(20 * np.cos(angles[3]), abs=0.001), "no terminal quantity, as recorded"
