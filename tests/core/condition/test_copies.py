"""Records of one event in several formats, and records that are none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.condition.copies import Outline, is_copy, outline_of
from core.recordings import Recording, comtrade, read
from core.recordings.comtrade.writer import DataFormat
from core.recordings.fidelity import Fidelity, fidelity_of
from testing.machines.motors import REFERENCE
from testing.machines.starts import StartRecord
from tests.core.recordings.comtrade_files import RECORD_1999

FORMATS: dict[str, tuple[DataFormat, Fidelity]] = {
    "OSC32F001.CFG": ("FLOAT32", Fidelity.FLOAT),
    "OSC16B001.CFG": ("BINARY", Fidelity.BINARY),
    "OSCA001.CFG": ("ASCII", Fidelity.TEXT),
    "EVENT.CFF": ("BINARY32", Fidelity.BINARY),
}


@pytest.fixture(scope="module")
def event() -> Recording:
    return StartRecord(duration_s=0.4, snr_db=50.0).of(REFERENCE)


def outlined(recording: Recording, fidelity: Fidelity = Fidelity.BINARY) -> Outline:
    found = outline_of(recording, REFERENCE, fidelity)
    assert found is not None
    return found


@pytest.mark.parametrize("name", FORMATS)
def test_each_format_of_an_event_is_a_copy_of_it(tmp_path: Path, event: Recording, name: str) -> None:
    data_format, fidelity = FORMATS[name]
    other = replace(event, station="another")
    path = comtrade.write(tmp_path / name, other, revision=2013, data_format=data_format)
    assert fidelity_of(path) is fidelity
    assert is_copy(outlined(read(path), fidelity), outlined(event))


def test_names_of_channels_and_missing_samples_do_not_count(event: Recording) -> None:
    channels = tuple(
        replace(one, name=one.name.replace("I", "I L").replace("V", "U L")) for one in event.channels
    )
    samples = event.samples.copy()
    samples[:, 100] = np.nan
    assert is_copy(outlined(replace(event, channels=channels, samples=samples)), outlined(event))


@pytest.mark.parametrize(
    "other",
    [
        lambda event: replace(event, start_time_ns=event.start_time_ns + 2_000_000),
        lambda event: replace(event, samples=1.003 * event.samples),
        lambda event: replace(event, samples=event.samples * np.array([[1.004], *[[1.0]] * 5])),
        lambda event: replace(event, samples=event.samples[:3], channels=event.channels[:3]),
    ],
    ids=["later", "larger", "one channel", "no voltages"],
)
def test_what_is_no_copy(event: Recording, other: object) -> None:
    assert callable(other)
    assert not is_copy(outlined(other(event)), outlined(event))


def test_what_has_no_time_or_no_currents_has_no_outline(event: Recording) -> None:
    assert outline_of(replace(event, start_time_ns=None), REFERENCE, Fidelity.TEXT) is None
    voltages = replace(event, samples=event.samples[3:], channels=event.channels[3:])
    assert outline_of(voltages, REFERENCE, Fidelity.TEXT) is None


def test_the_format_is_that_of_its_line_and_of_no_name(tmp_path: Path) -> None:
    path = RECORD_1999.but(identification="BINARY FLOAT32,RELAY,1999", data_format="ASCII").write(tmp_path)
    assert fidelity_of(path) is Fidelity.TEXT
    wide = tmp_path / "WIDE.CFG"
    wide.write_bytes(path.read_bytes().decode().replace("ASCII", "float32").encode("utf-16"))
    assert fidelity_of(wide) is Fidelity.FLOAT


@pytest.mark.parametrize(
    ("name", "fidelity"), [("a.CEV", Fidelity.TEXT), ("a.csv", Fidelity.TEXT), ("a.parquet", Fidelity.FLOAT)]
)
def test_tables_of_numbers_are_finer_than_text(name: str, fidelity: Fidelity) -> None:
    assert fidelity_of(Path(name)) is fidelity
