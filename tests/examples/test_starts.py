"""The example of starts tells the causes that it simulates."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.campaign
def test_the_causes_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / "why_starts_changed.py"), run_name="__main__")

    told = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")]
    assert told == [
        "as before: as-before, no cause",
        "a weak supply: changed, supply",
        "a sticking load: changed, load",
    ]
