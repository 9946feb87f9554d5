"""docs/reference/audit.md says what the audit trail has and finds; its program verifies an export."""

import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

from service.audit.actions import MEANINGS, AuditAction
from service.audit.entries import NO_HASH, AuditEntry, line, sealed
from service.audit.verification import Fault
from tests.docs.audit_actions import PAGE, written


def page() -> str:
    return PAGE.read_text(encoding="utf-8")


def test_the_actions_are_those_of_the_code() -> None:
    assert list(MEANINGS) == list(AuditAction)
    assert page() == written(page()), "the actions have changed: run `make docs` and commit the page"


def test_every_field_of_an_entry_is_told() -> None:
    section = page().partition("## What an entry has\n")[2].partition("\n## ")[0]
    told = [
        name
        for cell in re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
        for name in re.findall(r"`(\w+)`", cell)
    ]
    assert told == [field.name.removesuffix("_ns") for field in fields(AuditEntry)]


def test_every_fault_is_told() -> None:
    section = page().partition("| `fault` |")[2].partition("\n## ")[0]
    assert re.findall(r"^\| `([\w-]+)` \|", section, re.MULTILINE) == list(Fault)


@pytest.mark.parametrize("is_changed", [False, True])
def test_the_program_of_the_page_verifies_an_export(tmp_path: Path, *, is_changed: bool) -> None:
    previous, lines = NO_HASH, []
    for number in range(1, 4):
        about = ("anna", "10.0.0.7", "", "note-added", "motor", 'PÜMP "1"\n', None, '{"text":"\\u2028é"}')
        entry = sealed(AuditEntry(number, 1_800_000_000_000_000_000 + number, *about, previous, ""))
        lines.append(line(entry).replace("anna", "bert") if is_changed and number == 2 else line(entry))
        previous = entry.hash
    (tmp_path / "trail.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
    program = page().partition("```python\n")[2].partition("```")[0]
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == int(is_changed), done.stderr
