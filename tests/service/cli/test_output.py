"""One line for people, one document for programs."""

import json
from pathlib import Path

import pytest

from core.error_words import one_line
from core.recordings import RecordingError
from service.cli.output import CommandError, failing_clearly, print_failure


def test_a_failure_names_its_fields(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(CommandError) as caught, failing_clearly(RecordingError):
        raise RecordingError(Path("HR_1.CFG"), "line 2", expected="a count", found="'x'")
    print_failure(caught.value, in_json=True)
    output = capsys.readouterr()
    assert output.err == "mcc: HR_1.CFG: line 2: expected a count, found 'x'\n"
    error = json.loads(output.out)["error"]
    assert (error["field"], error["expected"], error["found"]) == ("line 2", "a count", "'x'")


def test_hostile_text_stays_one_line() -> None:
    assert one_line("a\nb\x1b[31mc\u202e ") == "a b [31mc"


def test_a_bug_is_not_hidden() -> None:
    with pytest.raises(ZeroDivisionError), failing_clearly(OSError):
        raise ZeroDivisionError
