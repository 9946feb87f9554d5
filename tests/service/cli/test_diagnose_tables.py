"""`mcc diagnose` and `mcc follow` on tables: verdicts as on COMTRADE, by columns that a person names."""

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa
import pytest
from nptdms import ChannelObject, TdmsWriter
from pyarrow import parquet
from scipy.io import savemat

from core.machines.motor_file.reader import read_motor
from core.machines.motor_file.writer import write_motor
from core.recordings import Recording, comtrade
from core.table_layout import TableScaling
from service.cli.app import main
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault, recording, running

NAMES = ("IA", "IB", "IC", "VA", "VB", "VC")
FAULTY = recording(running(REFERENCE, 0.6, fault=Fault(0.04, 1)), noise=0.002)
MAPPING = tuple(
    word for name in NAMES for word in ("--column", f"{name.lower()}=probe {name[0]}.{'ABC'.index(name[1])}")
)


@pytest.fixture
def motor(tmp_path: Path) -> Path:
    return write_motor(tmp_path / "motor.toml", REFERENCE)


def columns(record: Recording = FAULTY) -> Mapping[str, np.ndarray]:
    return {"time": record.time_s, **dict(zip(NAMES, record.samples, strict=True))}


def csv(path: Path, table: Mapping[str, np.ndarray], header: str = "", separator: str = ",") -> Path:
    path = path.with_suffix(".csv")
    rows = np.column_stack(list(table.values()))
    np.savetxt(path, rows, "%.7g", separator, header=header or separator.join(table), comments="")
    return path


def decimal_commas(path: Path) -> Path:
    path = csv(path, columns(), separator=";")
    path.write_text(path.read_text("utf-8").replace(".", ","), "utf-8")
    return path


def by_parquet(path: Path) -> Path:
    path = path.with_suffix(".parquet")
    parquet.write_table(pa.table(dict(columns())), path)
    return path


def matlab(path: Path) -> Path:
    path = path.with_suffix(".mat")
    savemat(path, dict(columns()))
    return path


def matlab73(path: Path) -> Path:
    path = path.with_suffix(".mat")
    with h5py.File(path, "w") as file:
        for name, values in columns().items():
            file[name] = values
    return path


def tdms(path: Path) -> Path:
    path = path.with_suffix(".tdms")
    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("motor", name, values) for name, values in columns().items()])
    return path


def npz(path: Path) -> Path:
    path = path.with_suffix(".npz")
    np.savez(path, **dict(columns()))  # type: ignore[arg-type]  # arrays by name
    return path


FORMS: tuple[Callable[[Path], Path], ...] = (
    *(lambda path: csv(path, columns()), decimal_commas, by_parquet, matlab, matlab73, tdms, npz),
)


def diagnosed(capsys: pytest.CaptureFixture[str], *words: object) -> Any:
    assert main(["diagnose", *map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refused(capsys: pytest.CaptureFixture[str], *words: object) -> str:
    assert main(["diagnose", *map(str, words), "--json"]) in (1, 2)
    return str(json.loads(capsys.readouterr().out)["error"]["message"])


@pytest.mark.parametrize("write", FORMS)
def test_each_form_has_the_verdict_of_the_same_comtrade_record(
    tmp_path: Path, motor: Path, capsys: pytest.CaptureFixture[str], write: Callable[[Path], Path]
) -> None:
    beside = diagnosed(
        capsys, comtrade.write(tmp_path / "relay.CFG", FAULTY, data_format="FLOAT32", revision=2013)
    )
    found = diagnosed(capsys, write(tmp_path / "table"), "--motor", motor)
    assert (found["verdict"], found["phase"]) == ("fault", "b")
    assert found["mu_f"] == pytest.approx(beside["mu_f"], rel=1e-3)
    assert any("without a unit" in one["message"] for one in found["quality"])


def test_columns_of_any_name_are_mapped_scaled_and_shifted(
    tmp_path: Path, motor: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = {"n": np.arange(FAULTY.samples.shape[1])}
    for name, values in zip(NAMES, FAULTY.samples, strict=True):
        scale, offset = (0.02, -3.0) if name[0] == "I" else (0.5, 0.0)
        named[f"probe {name[0]}.{'ABC'.index(name[1])}"] = (values - offset) / scale
    path = csv(tmp_path / "logger", named)
    scaling = ("--current-scale", 0.02, "--current-offset", -3.0, "--voltage-scale", 0.5, "--rate", 10_000)
    found = diagnosed(capsys, path, *MAPPING, *scaling)
    assert (found["verdict"], found["phase"]) == ("fault", "b")
    assert found["mu_f"] == pytest.approx(0.04, rel=0.15)


def test_the_motor_file_may_say_all_that(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    channels = replace(
        REFERENCE.channels, currents=("1", "2", "3"), phase_voltages=("4", "5", "6"), line_voltages=None
    )
    scaling = TableScaling(
        sample_rate_hz=10_000.0,
        current_scale=(0.5, 1.0, 2.0),
        voltage_scale=(1e3,) * 3,
        current_offset=(0.1,) * 3,
    )
    path = write_motor(tmp_path / "motor.toml", replace(REFERENCE, channels=channels, tables=scaling))
    assert read_motor(path).tables == scaling
    factors = np.array([0.5, 1.0, 2.0, 1e3, 1e3, 1e3])[:, np.newaxis]
    shift = np.array([0.1] * 3 + [0.0] * 3)[:, np.newaxis]
    np.save(tmp_path / "record.npy", ((FAULTY.samples - shift) / factors).T)
    found = diagnosed(capsys, tmp_path / "record.npy")
    assert (found["verdict"], found["phase"]) == ("fault", "b")
    assert found["mu_f"] == pytest.approx(0.04, rel=0.15)


@pytest.mark.parametrize("scale", [2_000.0, 0.01])
def test_counts_are_no_amperes(
    tmp_path: Path, motor: Path, capsys: pytest.CaptureFixture[str], scale: float
) -> None:
    table = dict(columns())
    for name in NAMES[:3]:
        table[name] = scale * table[name]
    found = diagnosed(capsys, csv(tmp_path / "raw", table), "--motor", motor)
    assert (found["verdict"], found["mu_f"]) == ("undiagnosable", None)
    assert "counts, not amperes" in found["reasons"][0]
    assert "--current-scale" in found["reasons"][0]


def test_counts_in_a_relays_record_are_no_volts(
    tmp_path: Path, motor: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    samples = FAULTY.samples.copy()
    samples[3:] = np.round(60.0 * samples[3:])
    record = replace(FAULTY, samples=samples)
    path = comtrade.write(tmp_path / "relay.CFG", record, data_format="FLOAT32", revision=2013)
    found = diagnosed(capsys, path, "--motor", motor)
    assert "counts, not volts" in found["reasons"][0]
    assert "voltage_ratio" in found["reasons"][0]


@pytest.mark.parametrize(
    ("header", "words", "said"),
    [
        ("n,IA,IB,IC,VA,VB,VC", (), "sample_rate_Hz"),
        ("t,IA,IB,IC,VA,VB,VC", ("--rate", "5000"), "10000 Hz"),
        ("t,IA [mV],IB [mV],IC [mV],VA,VB,VC", (), "current of phase a, b, c"),
        ("t,a [V],b [V],c [V],VA,VB,VC", ("ia=a [V]", "ib=b [V]", "ic=c [V]"), "--current-scale"),
        ("t,IA,IB,IC,VA,VB,VC", ("ia=IA",), "ia, ib, ic together"),
        ("t,IA,IB,IC,VA,VB,VC", ("iq=IA",), "found 'iq=IA'"),
    ],
)
def test_what_is_not_known_of_a_table_is_asked_for(
    tmp_path: Path,
    motor: Path,
    capsys: pytest.CaptureFixture[str],
    header: str,
    words: tuple[str, ...],
    said: str,
) -> None:
    table = dict(columns())
    if header[0] == "n":
        table["time"] = np.arange(table["IA"].size)
    options = words if words[:1] == ("--rate",) else [part for one in words for part in ("--column", one)]
    assert said in refused(capsys, csv(tmp_path / "record", table, header), "--motor", motor, *options)


def test_tables_named_after_their_time_are_followed(
    tmp_path: Path, motor: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for day in (1, 2, 3):
        record = recording(running(REFERENCE, 0.5), noise=0.002, seed=day)
        csv(tmp_path / f"mill_2026-01-0{day}T12-00-00", columns(record))
    (tmp_path / "README.txt").write_text("not a record", "utf-8")
    assert main(["follow", str(tmp_path), "--motor", str(motor), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    times = [one["time"] for one in document["history"]]
    assert times == [f"2026-01-0{day}T12:00:00.000000000Z" for day in (1, 2, 3)]
    assert document["skipped"] == []
