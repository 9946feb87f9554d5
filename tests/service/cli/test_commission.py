"""`mcc commission`: recordings of starts in, MOTOR.toml out."""

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from core.machines.motor_file.reader import read_motor, read_plate
from core.machines.stator_winding import StatorWinding, WindingKind
from core.recordings import comtrade, read
from examples import make_start_record
from service.cli import main
from testing.machines.motors import REFERENCE
from testing.machines.starts import StartRecord

EXAMPLES = Path(make_start_record.__file__).parent
NAMEPLATE = """
[nameplate]
rated_power_W = 800
rated_voltage_V = 380
rated_frequency_Hz = 50
pole_pairs = 2
connection = "star"

[channels]
ia = "IA"
ib = "IB"
ic = "IC"

[limits]
fault_level = 0.01
"""


@pytest.fixture
def nameplate(tmp_path: Path) -> Path:
    path = tmp_path / "plate.toml"
    path.write_text(NAMEPLATE, "utf-8")
    return path


def recorded(folder: Path, name: str, **how: float) -> Path:
    record = StartRecord(duration_s=0.6, snr_db=40.0, **how)  # type: ignore[arg-type]
    return comtrade.write(folder / f"{name}.CFG", record.of(REFERENCE))


def test_two_starts_and_a_nameplate_become_a_motor_file(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    records = [recorded(tmp_path, "HR_1", load_level=0.7), recorded(tmp_path, "HR_2", load_level=0.2)]
    output = tmp_path / "PUMP-7.toml"
    arguments = ["commission", *map(str, records), "--nameplate", str(nameplate), "--output", str(output)]
    assert main([*arguments, "--load", "constant", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["identifiable"] is True
    assert document["fixed"] == ["rotor_leakage_H"]
    assert document["output"] == str(output)
    assert [one["load_level"] for one in document["records"]] == pytest.approx([0.7, 0.2], abs=0.02)
    motor = read_motor(output)
    assert motor.limits.fault_level == 0.01
    assert motor.channels.currents == ("IA", "IB", "IC")
    for name, truth in (("stator_resistance_ohm", 8.4), ("inertia_kgm2", 0.0229)):
        low, high = document["parameters"][name]["ci95"]
        assert getattr(motor.parameters, name) == pytest.approx(truth, rel=0.01)
        assert low < getattr(motor.parameters, name) < high
    text = output.read_text("utf-8")
    assert "[intervals]" in text
    assert "HR_1.CFG, HR_2.CFG" in text
    assert "rotor_leakage_H = 0.0" in text
    assert "# fixed: 1 times the stator's" in text


def test_the_winding_of_the_nameplate_file_is_kept(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with nameplate.open("a", encoding="utf-8") as file:
        file.write('[winding]\nkind = "lap"\nslots = 24\ncoil_pitch_slots = 5\n')
    output = tmp_path / "out.toml"
    words = [
        "commission",
        str(recorded(tmp_path, "HR_9")),
        "--nameplate",
        str(nameplate),
        "--load",
        "constant",
    ]
    assert main([*words, "--output", str(output), "--json"]) == 0
    given = {"kind": "lap", "slots": 24, "layers": 2, "coil_pitch_slots": 5}
    assert json.loads(capsys.readouterr().out)["winding"] == given
    assert read_motor(output).winding == StatorWinding(WindingKind.LAP, 24, 2, 5)


def test_a_person_reads_what_was_fixed(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.toml"
    arguments = ["commission", str(recorded(tmp_path, "HR_3")), "--nameplate", str(nameplate)]
    assert main([*arguments, "--output", str(output), "--load", "constant"]) == 0
    shown = capsys.readouterr()
    assert "stator_resistance_ohm" in shown.out
    assert "fixed: 1 times the stator's" in shown.out
    assert "no [parameters]" in shown.out
    assert shown.err == ""
    assert read_plate(output).parameters is not None


def test_a_motor_already_running_is_refused_and_nothing_is_written(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = StartRecord().of(REFERENCE)
    record = comtrade.write(
        tmp_path / "RUN.CFG", replace(whole, samples=whole.samples[:, 7_000:], trigger_index=0)
    )
    output = tmp_path / "out.toml"
    arguments = ["commission", str(record), "--nameplate", str(nameplate), "--output", str(output)]
    assert main([*arguments, "--json"]) == 1
    shown = capsys.readouterr()
    error = json.loads(shown.out)["error"]
    assert "already running" in error["found"]
    assert "not identifiable" in error["found"]
    assert error["field"] == "start"
    assert "RUN.CFG" in shown.err
    assert not output.exists()


def test_a_warning_is_said_in_the_answer_in_the_file_and_to_whoever_watches(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = StartRecord(duration_s=0.5, snr_db=40.0).of(REFERENCE)
    twice = np.array([[2.0]] * 3 + [[1.0]] * 3)
    wide = tuple(replace(one, full_scale=4.0 * (one.full_scale or 0.0)) for one in whole.channels)
    doubled = replace(whole, samples=whole.samples * twice, channels=wide)
    record = comtrade.write(tmp_path / "HR_4.CFG", doubled)
    output = tmp_path / "out.toml"
    arguments = ["commission", str(record), "--nameplate", str(nameplate), "--output", str(output)]
    assert main([*arguments, "--load", "constant", "--json"]) == 0
    shown = capsys.readouterr()
    (warning,) = json.loads(shown.out)["warnings"]
    assert "current transformers' ratio" in warning
    assert shown.err == f"mcc: warning: {warning}\n"
    assert f"# WARNING: {warning}" in output.read_text("utf-8")


@pytest.mark.parametrize("spelled", ["plate.toml", "./plate.toml", "link.toml", "HR_1.CFG", "HR_1.DAT"])
def test_what_is_read_is_never_overwritten(
    tmp_path: Path,
    nameplate: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    spelled: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("link.toml").symlink_to(nameplate)
    for part in ("HR_1.CFG", "HR_1.DAT"):
        Path(part).write_text("kept", "utf-8")
    before = Path(spelled).read_bytes()
    assert main(["commission", "HR_1.CFG", "--nameplate", str(nameplate), "--output", spelled, "--json"]) == 2
    shown = capsys.readouterr()
    error = json.loads(shown.out)["error"]
    assert f"--output {Path(spelled)}: expected a file to write the motor to" in error["message"]
    assert "a file that is read; name another" in shown.err
    assert Path(spelled).read_bytes() == before


def test_an_output_that_cannot_be_written_is_refused_before_anything_is_computed(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cases = {
        tmp_path / "nowhere" / "out.toml": "no folder",
        nameplate / "out.toml": "no folder",
        tmp_path: "a folder; name the file in it",
    }
    for output, expected in cases.items():
        arguments = ["commission", "HR_1.CFG", "--nameplate", str(nameplate), "--output", str(output)]
        assert main(arguments) == 2
        assert expected in capsys.readouterr().err


def test_a_file_system_that_refuses_at_the_end_is_named(
    tmp_path: Path, nameplate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = recorded(tmp_path, "HR_5")
    output = tmp_path / "out.toml"
    output.with_name("out.toml.part").mkdir()
    arguments = ["commission", str(record), "--nameplate", str(nameplate), "--output", str(output)]
    assert main([*arguments, "--load", "constant", "--json"]) == 1
    error = json.loads(capsys.readouterr().out)["error"]
    assert error["type"] == "MotorFileError"
    assert error["expected"] == "a file that can be written"
    assert str(output) in error["message"]


def test_the_example_tells_the_motor_it_was_made_with(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = EXAMPLES / "START.CFG"
    assert sum(one.stat().st_size for one in EXAMPLES.glob("START.*")) < 300_000
    output = tmp_path / "PUMP-7.toml"
    arguments = ["commission", str(record), "--nameplate", str(EXAMPLES / "nameplate.toml")]
    assert main([*arguments, "--output", str(output), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["warnings"] == []
    found, truth = read_motor(output).parameters, read_motor(EXAMPLES / "motor.toml").parameters
    for name, value in asdict(truth).items():
        assert getattr(found, name) == pytest.approx(value, rel=0.01)
    again = make_start_record.start_record()
    assert np.abs(read(record).samples - again.samples).max() < 0.1


def test_wrong_use_names_what_is_missing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["commission", str(tmp_path / "HR_1.CFG")]) == 2
    assert "--nameplate" in capsys.readouterr().err
    missing = tmp_path / "nowhere.toml"
    arguments = ["commission", "HR_1.CFG", "--nameplate", str(missing), "--output", str(tmp_path / "o.toml")]
    assert main([*arguments, "--json"]) == 1
    assert "nowhere.toml" in json.loads(capsys.readouterr().out)["error"]["message"]
