"""The commissioning checklist names commands and options that there are."""

import re

import pytest

from tests.docs.pages import ROOT

CHECKLIST = (ROOT / "docs" / "how-to" / "commissioning-checklist.md").read_text("utf-8")
COMMANDS = (ROOT / "docs" / "reference" / "commands.md").read_text("utf-8")
NAMED = sorted(set(re.findall(r"`mcc ([^`]+)`", CHECKLIST)))


@pytest.mark.parametrize("command", NAMED)
def test_a_command_of_the_checklist_exists(command: str) -> None:
    sections = dict(re.findall(r"^## mcc (.+)\n([^#]*(?:#(?!# )[^#]*)*)", COMMANDS, re.M))
    heading = max((one for one in sections if command.startswith(one)), key=len)
    for option in re.findall(r"--[a-z-]+", command):
        assert f"`{option}" in sections[heading]


def test_the_checklist_has_commands() -> None:
    assert len(NAMED) > 10
