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


def test_it_tells_how_long_a_record_it_takes_where_half_a_second_is_too_short(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = EXAMPLE.parent
    monkeypatch.setattr(sys, "argv", [EXAMPLE.name, str(folder / "RUNNING.CFG"), str(folder / "motor.toml")])
    (line,) = _printed(capsys)
    # The simulated motor's slip is 2.49 %. What its shorted turns lose would pass for a higher one.
    assert re.match(r"unsupported: the sidebands lie 2\.[45]\d Hz beside .*: it takes 0\.\d s", line), line
