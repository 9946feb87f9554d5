"""Time and memory that files may cost: long ones, and those made to cost more than they weigh."""

import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Channel, Digitals, Quantity, Recording, RecordingError, comtrade, read
from tests.core.recordings.cev_files import REPORT
from tests.core.recordings.comtrade_files import RECORD_1999

MB = 1 << 20
TIMES_FILE, BESIDE = 10, 3 * MB
"""What is allowed is 64 MB; files too small to show what they cost would hide behind it."""

ALLOWED_CPU_S = 4.0
"""The slowest takes half a second on a quiet machine; what grows with the square of the size, minutes."""


@pytest.fixture(scope="module")
def minute(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """60 s of 6 channels and 32 states at 10 kHz, BINARY."""
    rng = np.random.default_rng(1)
    recording = Recording(
        samples=rng.uniform(-1, 1, (6, 600_000)),
        sample_rate_hz=10_000.0,
        start_time_ns=0,
        channels=tuple(Channel(name, Quantity.CURRENT, None, "A", 1.0) for name in "ABCDEF"),
        trigger_index=5,
        digitals=Digitals.of(tuple(f"S{k}" for k in range(32)), rng.random((600_000, 32)) > 0.5),
    )
    return comtrade.write(tmp_path_factory.mktemp("minute") / "r.cfg", recording)


def peak_bytes(call: Callable[[], object]) -> int:
    tracemalloc.start()
    try:
        call()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_minute_of_10_khz_is_read_within_0_3_s(minute: Path) -> None:
    durations = []
    for _ in range(5):
        begun = time.process_time()
        recording = read(minute)
        durations.append(time.process_time() - begun)
    assert recording.samples.shape == (6, 600_000)
    assert recording.digitals is not None
    assert min(durations) < 0.3


def test_it_takes_three_times_its_size_in_memory(minute: Path) -> None:
    assert peak_bytes(lambda: read(minute)) <= 3 * minute.with_suffix(".dat").stat().st_size


CFG = RECORD_1999.configuration().encode()
ASCII = RECORD_1999.but(data_format="ASCII")
FEW = CFG.replace(b"BINARY", b"ASCII").replace(b"1000,5", b"1000,5000000")
NARROW = (
    b"P,R,1999\n1,1A,0D\n1,IA,A,,A,1,0,0,0,0,1,1,P\n50\n1\n1000,300000\n"
    b"21/11/2024,06:30:00.0\n21/11/2024,06:30:00.0\nASCII\n1\n"
)
COSTLY: dict[str, dict[str, bytes]] = {
    "configuration of line ends": {".cfg": b"\n" * (MB)},
    "configuration of commas": {".cfg": b"," * (MB)},
    "accents without end": {".cfg": b"a\xff\xff " * (MB // 4)},
    "names without end": {".cfg": CFG.replace(b"PLANT", b"P" * (MB))},
    "channels announced by the million": {".cfg": b"P,R,1999\n999999,999999A,0D\n" + b"1\n" * (MB // 2)},
    "a number of digits alone": {".cfg": CFG.replace(b"0.01", b"1" * 9000 + b"x")},
    "a report's number of digits alone": {".cev": REPORT.but(rows=["1" * MB + "x,,,,,,"]).content()},
    "a report's number of many digits": {".cev": REPORT.but(rows=["1" * (MB - 99) + ",,,,,,"]).content()},
    "samples announced by the milliard": {
        ".cfg": CFG.replace(b"1000,5", b"1000,9999999999"),
        ".dat": b"1" * 90,
    },
    "narrow lines": {".cfg": NARROW, ".dat": b",,\n" * 300_000},
    "line ends": {".cfg": FEW, ".dat": b"\n" * (MB)},
    "line ends and a digit": {".cfg": FEW, ".dat": b"\n" * (MB) + b"1"},
    "carriage returns and blanks": {".cfg": FEW, ".dat": b"\r " * (MB // 2) + b"1"},
    "commas": {".cfg": FEW, ".dat": b"," * (MB)},
    "padding": {".cfg": CFG, ".dat": RECORD_1999.data() + b"\x1a" * (MB)},
    "combined file of dashes": {".cff": b"--- file type: CFG " * (MB // 20)},
    "combined file of sections": {".cff": b"--- file type: INF ---\n" * (MB // 20)},
    "report of line ends": {".cev": b'"FID","0143"\n' + b"\n" * (MB)},
    "report of prompts": {".cev": b'"FID","0143"\n' + b"=\n" * (MB // 2)},
    "report of quotes": {".cev": b'"FID","0143"\n' + b'"' * (MB)},
    "report of commas": {".cev": b'"FID","0143"\n' + b"," * (MB)},
    "report of short lines": {".cev": REPORT.content() + b',"002C"\n' * (MB // 8)},
    "settings of quotes": {".cev": REPORT.content() + b'","0000"' * (MB // 8)},
}


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize("files", COSTLY.values(), ids=COSTLY)
def test_costly_files(tmp_path: Path, files: dict[str, bytes], lenient: bool) -> None:
    for suffix, content in ({".dat": b""} | files).items():
        (tmp_path / f"r{suffix}").write_bytes(content)
    entry = tmp_path / f"r{next(iter(files))}"

    def attempt() -> None:
        try:
            read(entry, lenient=lenient)
        except RecordingError:
            return

    begun = time.process_time()
    attempt()
    assert time.process_time() - begun < ALLOWED_CPU_S
    size = sum(map(len, files.values()))
    assert peak_bytes(attempt) <= TIMES_FILE * size + BESIDE
