"""The page about stator windings: its command runs, its windings can be wound, typical ones are right."""

import re
import tomllib
from pathlib import Path

import pytest

from core.machines.motor_file.reader import motor_from_table, read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import Nameplate
from core.machines.stator_winding import StatorWinding, WindingKind, check_winding
from core.machines.typical_winding import (
    LARGE_MOTORS_SLOTS,
    ONE_LAYER_W,
    SMALL_MOTORS_SLOTS,
    TWO_LAYERS_W,
    typical_winding,
)
from service.cli import main
from testing.machines.motors import REFERENCE

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "stator-winding.md").read_text(encoding="utf-8")
EXAMPLE = re.compile(
    r"^\| (\d) poles, ([\d.]+) kW.*\| (\w+), (\d+) slots, (\d) layers?(?:, pitch (\d+))? \|$", re.MULTILINE
)


def test_the_table_of_the_page_is_read() -> None:
    (table,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    plate = {"rated_power_W": 7500, "rated_voltage_V": 400, "rated_frequency_Hz": 50, "pole_pairs": 2}
    motor = motor_from_table({"nameplate": plate, **tomllib.loads(table)}, name="M", source="page")
    assert motor.winding == StatorWinding(WindingKind.LAP, 36, 2, 8)


def test_the_command_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (command,) = re.findall(r"^ {4}mcc (parameters .*)$", PAGE, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    write_motor(tmp_path / "pump.toml", REFERENCE)
    assert main(command.split()) == 0
    assert read_motor(tmp_path / "PUMP-7.toml").winding == StatorWinding(WindingKind.LAP, 36, 2, 8)


def test_the_windings_of_the_page_can_be_wound_and_most_are_typical() -> None:
    examples = EXAMPLE.findall(PAGE)
    assert len(examples) == 7
    for poles, power_kW, kind, slots, layers, pitch in examples:
        winding = StatorWinding(WindingKind(kind), int(slots), int(layers), int(pitch) if pitch else None)
        check_winding(winding, int(poles) // 2)
        typical = typical_winding(Nameplate(1e3 * float(power_kW), 400.0, 50.0, int(poles) // 2))
        assert winding.slots in typical.slots


def test_what_is_typical_is_as_the_page_has_it() -> None:
    assert f"up to {ONE_LAYER_W / 1e3:g} kW" in PAGE
    assert f"from {TWO_LAYERS_W / 1e3:g} kW on" in PAGE
    for table in (SMALL_MOTORS_SLOTS, LARGE_MOTORS_SLOTS):
        rows = [
            f"{', '.join(map(str, others))} or {last}"
            for *others, last in (table[pairs] for pairs in sorted(table))
        ]
        assert "; ".join(rows) in PAGE
