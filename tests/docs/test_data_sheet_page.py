"""The page on data sheets: its commands give what it says, and its arithmetic is right."""

import re
import shlex
import tomllib
from math import pi
from pathlib import Path
from typing import Any

import pytest

from core.machines.motor_file.reader import read_motor
from core.machines.parameters import ParametersSource
from service.cli import main
from tests.docs.pages import ROOT

PAGE = (ROOT / "docs" / "how-to" / "parameters-from-data-sheets.md").read_text(encoding="utf-8")
COMMANDS = [shlex.split(line) for line in re.findall(r"^    mcc (parameters .*)$", PAGE, re.MULTILINE)]
TABLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A fresh folder with the files that the page has one write."""
    monkeypatch.chdir(tmp_path)
    pump, fan, _ = TABLES
    (tmp_path / "pump.toml").write_text(pump, "utf-8")
    (tmp_path / "fan.toml").write_text(fan, "utf-8")
    return tmp_path


def test_impedances_become_a_motor_file(folder: Path) -> None:
    of_impedances, _ = COMMANDS
    assert main(of_impedances) == 0
    motor = read_motor(folder / "PUMP-7.toml")
    machine, w = motor.parameters, 2.0 * pi * 50.0
    assert motor.parameters_source is ParametersSource.DATA_SHEET
    assert machine.stator_resistance_ohm == pytest.approx(0.230)
    assert machine.stator_leakage_H == pytest.approx(1.815 / w, rel=1e-6)
    assert machine.rotor_leakage_H == pytest.approx(2.057 / w, rel=1e-6)
    assert machine.stator_self_inductance_H == pytest.approx(77.4 / w / 1.5, rel=1e-6)
    assert motor.tolerances.stator_leakage_H == pytest.approx(0.2231, abs=1e-3)
    for figure in re.findall(r"\| (0\.\d+) (?:ohm|H) \|", PAGE):
        known = (machine.stator_resistance_ohm, machine.stator_leakage_H, machine.rotor_leakage_H)
        all_known = (*known, machine.magnetising_inductance_H, machine.stator_self_inductance_H)
        assert any(float(figure) == pytest.approx(one, rel=3e-4) for one in all_known), figure


def test_a_catalogue_gives_what_the_page_prints(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert folder.is_dir()
    _, of_catalogue = COMMANDS
    assert main(of_catalogue) == 0
    printed = capsys.readouterr().out
    assert printed.splitlines()[:9] == TABLES[2].splitlines()[:9]
    found: dict[str, Any] = tomllib.loads(printed)
    shown: dict[str, Any] = tomllib.loads(TABLES[2])
    assert found["parameters"].pop("source") == shown["parameters"].pop("source") == "data-sheet"
    assert found["nameplate"] == shown["nameplate"]
    assert found["parameters"] == pytest.approx(shown["parameters"], rel=1e-3)
    for name, ends in shown["intervals"].items():
        assert found["intervals"][name] == pytest.approx(ends, rel=2e-3), name
    assert "# rated current: 193.2 A by this circuit, 194 A given" in printed
