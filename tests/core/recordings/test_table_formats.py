"""Tables in Parquet, MATLAB, TDMS and NumPy files: one record in each gives the same columns and rate."""

import sys
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from nptdms import ChannelObject, TdmsWriter
from pyarrow import parquet
from scipy.io import savemat

from core.recordings import RecordingError
from core.recordings.tables.reading import TABLE_READERS, read_table

ROWS = 500
RATE_HZ = 5_000.0
TIME_S = np.arange(ROWS) / RATE_HZ
CURRENTS = {name: np.cos(314.0 * TIME_S - angle) for name, angle in (("ia", 0.0), ("ib", 2.1), ("ic", 4.2))}
START = datetime(2026, 1, 31, 12, tzinfo=UTC)
START_NS = 1_769_860_800_000_000_000


def with_time(path: Path) -> Mapping[str, np.ndarray]:
    return {"time": TIME_S, **CURRENTS}


def mat5(path: Path) -> None:
    savemat(path, {"time": TIME_S, **CURRENTS, "note": "a text"})


def mat5_structure(path: Path) -> None:
    savemat(path, {"motor": {"current": np.column_stack(list(CURRENTS.values()))}, "fs": RATE_HZ})


def mat73(path: Path) -> None:
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in {"time": TIME_S, **CURRENTS}.items():
            file.create_dataset(name, data=values.reshape(1, -1)).attrs["MATLAB_class"] = np.bytes_("double")
        file.create_dataset("note", data=np.arange(ROWS)).attrs["MATLAB_class"] = np.bytes_("char")


def hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["dt"] = 1.0 / RATE_HZ
        for name, values in CURRENTS.items():
            file[f"run/{name}"] = values
            file[f"run/{name}"].attrs["unit"] = "A"


def npy(path: Path) -> None:
    np.save(path, np.column_stack([TIME_S, *CURRENTS.values()]))


def npy_by_rows(path: Path) -> None:
    np.save(path, np.array([TIME_S, *CURRENTS.values()]))


def npy_with_fields(path: Path) -> None:
    table = np.zeros(ROWS, dtype=[(name, "f8") for name in ("time", *CURRENTS)])
    for name, values in {"time": TIME_S, **CURRENTS}.items():
        table[name] = values
    np.save(path, table)


def npz(path: Path) -> None:
    np.savez(path, sampling_rate=RATE_HZ, **CURRENTS)  # type: ignore[arg-type]  # arrays by name


def tdms(path: Path) -> None:
    waveform = {
        "wf_increment": 1.0 / RATE_HZ,
        "wf_start_time": np.datetime64("2026-01-31T12:00:00"),
        "unit_string": "A",
    }
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [ChannelObject("motor", name, values, waveform) for name, values in CURRENTS.items()]
        )


def by_parquet(path: Path) -> None:
    parquet.write_table(pa.table({"time": TIME_S, **CURRENTS, "note": ["x"] * ROWS}), path)


def parquet_with_dates(path: Path) -> None:
    instants = pa.array(START_NS + np.round(TIME_S * 1e9).astype(np.int64), pa.timestamp("ns", "UTC"))
    parquet.write_table(pa.table({"stamp": instants, **CURRENTS}), path)


FORMS: Mapping[str, tuple[str, Callable[[Path], None]]] = {
    "MATLAB 5": (".mat", mat5),
    "MATLAB 5, a structure": (".mat", mat5_structure),
    "MATLAB 7.3": (".mat", mat73),
    "HDF5": (".h5", hdf5),
    "NumPy": (".npy", npy),
    "NumPy by rows": (".npy", npy_by_rows),
    "NumPy with fields": (".npy", npy_with_fields),
    "NumPy archive": (".npz", npz),
    "TDMS": (".tdms", tdms),
    "Parquet": (".parquet", by_parquet),
    "Parquet with dates": (".parquet", parquet_with_dates),
}


@pytest.mark.parametrize("form", FORMS)
def test_each_form_gives_the_same_columns(tmp_path: Path, form: str) -> None:
    suffix, write = FORMS[form]
    path = tmp_path / f"record{suffix}"
    write(path)
    found = read_table(path)
    assert found.sample_rate_hz == pytest.approx(RATE_HZ)
    for column, values in zip(found.columns, CURRENTS.values(), strict=True):
        np.testing.assert_array_equal(column.values, values)


@pytest.mark.parametrize("form", ["TDMS", "Parquet with dates"])
def test_time_stamps_give_the_start(tmp_path: Path, form: str) -> None:
    suffix, write = FORMS[form]
    write(tmp_path / f"record{suffix}")
    assert read_table(tmp_path / f"record{suffix}").start_time_ns == START_NS == START.timestamp() * 1e9


def test_units_of_the_file_are_kept(tmp_path: Path) -> None:
    tdms(tmp_path / "record.tdms")
    assert {column.unit for column in read_table(tmp_path / "record.tdms").columns} == {"A"}


def test_what_is_left_out_is_named(tmp_path: Path) -> None:
    np.savez(tmp_path / "record.npz", fs=RATE_HZ, spare=np.zeros(20), **CURRENTS)  # type: ignore[arg-type]
    [note] = read_table(tmp_path / "record.npz").notes
    assert "spare (20 values)" in note


@pytest.mark.parametrize(
    ("suffix", "module"), [(".tdms", "nptdms"), (".mat", "h5py"), (".parquet", "pyarrow.parquet")]
)
def test_a_library_that_is_missing_is_named_with_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, module: str
) -> None:
    path = tmp_path / f"record{suffix}"
    path.write_bytes(b"\x89HDF\r\n\x1a\n")
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(RecordingError, match=r"pip install 'statorwatch\[tables\]'"):
        read_table(path)


def test_several_rates_of_one_length_are_refused(tmp_path: Path) -> None:
    with TdmsWriter(tmp_path / "record.tdms") as writer:
        writer.write_segment(
            [
                ChannelObject("motor", name, np.zeros(ROWS), {"wf_increment": step})
                for name, step in (("a", 1e-4), ("b", 2e-4))
            ]
        )
    with pytest.raises(RecordingError, match="one sampling interval"):
        read_table(tmp_path / "record.tdms")


HEADS = (
    b"",
    b"MATLAB 5.0 MAT-file",
    b"\x89HDF\r\n\x1a\n",
    b"PAR1",
    b"TDSm",
    b"\x93NUMPY\x01\x00",
    b"PK\x03\x04",
)


@settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(
    head=st.sampled_from(HEADS), rest=st.binary(max_size=200), cut=st.integers(0, 4_000), place=st.integers(0)
)
@pytest.mark.filterwarnings("ignore")
def test_damaged_files_are_refused(tmp_path: Path, head: bytes, rest: bytes, cut: int, place: int) -> None:
    contents = [head + rest]
    for suffix, write in FORMS.values():
        whole = tmp_path / f"whole{suffix}"
        if not whole.exists():
            write(whole)
        octets = bytearray(whole.read_bytes())
        octets[place % len(octets)] ^= 0x55
        contents.append(bytes(octets[: -cut or None]))
    for suffix in TABLE_READERS:
        for content in (contents[0], contents[1 + place % len(FORMS)]):
            path = tmp_path / f"junk{suffix}"
            path.write_bytes(content)
            try:
                found = read_table(path)
            except RecordingError:
                continue
            assert len({column.values.size for column in found.columns}) == 1
