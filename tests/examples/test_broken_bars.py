"""The example that looks for broken bars."""

import re
import runpy
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "find_broken_bars.py"


def _printed(capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    return [line for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")]


def test_without_files_it_tells_a_whole_cage_from_a_broken_bar(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", [EXAMPLE.name])
    whole, broken = _printed(capsys)
    assert whole.startswith("healthy: ")
    assert broken.startswith("fault: ")


def test_it_tells_what_half_a_second_of_a_whole_cage_would_show(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = EXAMPLE.parent
    monkeypatch.setattr(sys, "argv", [EXAMPLE.name, str(folder / "RUNNING.CFG"), str(folder / "motor.toml")])
    (line,) = _printed(capsys)
    assert re.match(r"healthy: no uneven rotor: this record would show -\d+\.\d dB$", line), line
