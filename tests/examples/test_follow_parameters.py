"""The example that follows a motor's parameters tells a wrong ratio."""

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "follow_parameters.py"


def test_a_wrong_ratio_is_told(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE)])
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    told = capsys.readouterr().out
    assert told.startswith("drifting after 52 records")
    assert "a CT or VT ratio changed" in told
    assert "magnetising inductance: drifting" in told
