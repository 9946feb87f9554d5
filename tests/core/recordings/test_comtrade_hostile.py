"""Bytes of any kind give a Recording or a RecordingError, never another exception and never a warning."""

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.recordings import Recording, RecordingError, read
from tests.core.recordings.comtrade_files import RECORD_1991, RECORD_1999, RECORD_2013, ComtradeFile

RECORDS = [
    *(RECORD_1991.but(data_format=f) for f in ("ASCII", "BINARY")),
    *(RECORD_1999.but(data_format=f) for f in ("ASCII", "BINARY")),
    *(RECORD_2013.but(data_format=f) for f in ("ASCII", "BINARY32", "FLOAT32")),
]
TOKENS = [
    b"0", b"-1", b"1", b"9" * 10, b"1e308", b"-1e308", b"1e-320", b"1e999", b"nan", b"inf", b"1_0",
    b"", b",", b"\r\n", b"\n", b"\r", b"\x1a", b"\x00", b"\xff", b"\x85", b" ", "٣".encode(), "²".encode(),
    b"99999", b"ASCII", b"FLOAT32", b"1991", b"2013", b"S", b"kA", b"00/00/0000", b"31/12/2200",
    b"23:59:60", b"-5h30",
]  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("hostile")


def try_to_read(path: Path) -> None:
    with contextlib.suppress(RecordingError):
        check(read(path))


def check(recording: Recording) -> None:
    """What is accepted has the shape and the finite figures the rest of the house builds on."""
    assert recording.samples.shape == (len(recording.channels), recording.samples.shape[1])
    assert not np.isinf(recording.samples).any()
    assert 0 < recording.sample_rate_hz < np.inf
    assert recording.trigger_index is not None
    assert 0 <= recording.trigger_index < recording.samples.shape[1]
    assert recording.duration_s > 0


@st.composite
def mutations(draw: st.DrawFn, content: bytes) -> bytes:
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(content)))
        end = start + draw(st.integers(0, 12))
        token = draw(st.sampled_from(TOKENS) | st.binary(max_size=4))
        content = content[:start] + token + content[end:]
    return content


@st.composite
def exchanged_fields(draw: st.DrawFn, content: bytes) -> bytes:
    """Other values in whole fields, which gets past the checks of layout."""
    lines = [line.split(b",") for line in content.split(b"\r\n")]
    for _ in range(draw(st.integers(1, 3))):
        line = draw(st.sampled_from(lines))
        line[draw(st.integers(0, len(line) - 1))] = draw(st.sampled_from(TOKENS))
    return b"\r\n".join(b",".join(line) for line in lines)


@settings(deadline=None)
@given(configuration=st.binary(max_size=300), data=st.binary(max_size=100))
def test_arbitrary_bytes(folder: Path, configuration: bytes, data: bytes) -> None:
    (folder / "a.dat").write_bytes(data)
    for name in ("a.cfg", "a.cff"):
        (folder / name).write_bytes(configuration)
        try_to_read(folder / name)


@settings(max_examples=300, deadline=None)
@given(record=st.sampled_from(RECORDS), data=st.data())
def test_mutated_files(folder: Path, record: ComtradeFile, data: st.DataObject) -> None:
    configuration = record.configuration().encode()
    (folder / "m.cfg").write_bytes(
        data.draw(st.just(configuration) | mutations(configuration) | exchanged_fields(configuration))
    )
    (folder / "m.dat").write_bytes(data.draw(st.just(record.data()) | mutations(record.data())))
    try_to_read(folder / "m.cfg")


@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_mutated_combined_files(folder: Path, data: st.DataObject) -> None:
    content = b"--- file type: CFG ---\r\n" + RECORD_2013.configuration().encode()
    content += b"--- file type: DAT BINARY: 90 ---\r\n" + RECORD_2013.data()
    (folder / "m.cff").write_bytes(data.draw(mutations(content)))
    try_to_read(folder / "m.cff")
