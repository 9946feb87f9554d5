"""How `mcc diagnose` prints a verdict."""

from dataclasses import replace
from pathlib import Path

import pytest

from core.diagnosis.verdict import QualityFinding
from service.cli.diagnose import _table
from service.cli.output import results
from tests.service.plants import undiagnosable

CLIPPED = "IA reads its full scale in 12 samples"


def test_what_keeps_a_record_from_being_diagnosed_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    diagnosis = replace(
        undiagnosable(),
        reasons=(CLIPPED,),
        quality=(
            QualityFinding("clipping", 12.0, 0.0, "1", passed=False, message=CLIPPED),
            QualityFinding("duration", 1.0, 0.2, "s", passed=True, message="long enough"),
        ),
    )
    results().print(_table(Path("HR_1.CFG"), diagnosis))
    shown = capsys.readouterr().out
    assert shown.count(CLIPPED) == 1
    (passed,) = [line for line in shown.splitlines() if "checks passed" in line]
    assert passed.split()[-2] == "1"
