"""The first commands of the README give what it says beside them."""

import json
import re
import shlex

import pytest

from service.cli import main
from tests.docs.pages import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_first_diagnosis_gives_a_verdict(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    lines = re.findall(r"^    mcc (diagnose examples/.*?) +# (.*)$", README, re.MULTILINE)
    found = []
    for command, said in lines:
        assert main([*shlex.split(command), "--json"]) == 0
        diagnosis = json.loads(capsys.readouterr().out)
        found.append((diagnosis["verdict"], diagnosis["phase"], diagnosis["operation"], said))
    assert found == [
        ("fault", "b", "running", "fault, phase b, 5 % of its turns"),
        ("undiagnosable", None, "start", "no verdict: a start, for mcc commission"),
    ]


def test_what_was_never_tried_is_said() -> None:
    assert "### What was never tried\n\nNo relay of any make was at hand" in README
