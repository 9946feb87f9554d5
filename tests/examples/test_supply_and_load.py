"""The examples that measure a supply, and make a load profile."""

import re
import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_supply_of_a_recording(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["measure_supply.py"])
    runpy.run_path(str(EXAMPLES / "measure_supply.py"), run_name="__main__")
    frequency, unbalance, harmonics, currents = capsys.readouterr().out.splitlines()
    assert re.match(r"50\.\d{3} Hz, line voltages \d{3}\.\d, \d{3}\.\d, \d{3}\.\d V", frequency), frequency
    assert re.match(r"unbalance [01]\.\d\d% \(IEC\), .* leaves \d+% of its power", unbalance), unbalance
    assert re.match(r"THD \d\.\d\d%, HVF 0\.0\d+", harmonics), harmonics
    assert "I2/I1" in currents


def test_the_load_of_a_day(capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / "load_of_a_day.py"), run_name="__main__")
    total, *classes, beyond = capsys.readouterr().out.splitlines()
    assert total.startswith("11 h running, 9 h standing, 4 h unknown; 1 start")
    hours = sum(float(re.findall(r"([\d.]+) h ", line)[0]) for line in classes)
    assert hours == pytest.approx(11.0)
    assert beyond == "beyond 100%: 1 h, 1 h without a break, at most 108%"
