"""Every command with junk: it ends, it says what is wrong, and with --json it prints a document."""

import io
import json
import os
from collections.abc import Sequence
from pathlib import Path

import pytest
import typer
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from service.cli.app import main
from tests.docs.command_reference import commands

RUN_ON = ("mcc demo", "mcc demo-status", "mcc serve", "mcc collect", "mcc work", "ied-sim")
"""Programs that are meant to go on, or wait for one that does."""
COMMANDS = {words: command for words, command in commands() if words not in RUN_ON}
NOWHERE = "http://127.0.0.1:1"

SUFFIXES = (
    *(".csv", ".tsv", ".txt", ".cfg", ".cff", ".cev", ".mat", ".npy", ".npz", ".parquet", ".tdms", ".h5"),
    *(".toml", ".scd", ".xml", ".zip", ""),
)
NUMBERS = st.one_of(
    st.floats().map(str), st.integers(-(10**30), 10**30).map(str), st.sampled_from(("", "-", "1e999", "0,5"))
)
TABLES = st.tuples(
    st.sampled_from((",", ";", "\t", " ")), st.lists(st.lists(NUMBERS, min_size=1, max_size=3), max_size=40)
).map(lambda drawn: "\n".join(drawn[0].join(row) for row in drawn[1]).encode())
CURRENTS = st.tuples(
    st.sampled_from(("time", "t_ms", "n", "")),
    st.sampled_from((1e-3, 1e-2, 1.0, 1e5, 0.0)),
    st.floats(0.0, 1e308),
).map(
    lambda drawn: "\n".join(
        (f"{drawn[0]},IA", *(f"{k * drawn[1]:.9g},{drawn[2] * ((k % 20) - 9.5)!r}" for k in range(1_000)))
    ).encode()
)
HEADS = st.sampled_from(
    (b"", b"MATLAB 5.0 MAT-file", b"\x89HDF\r\n\x1a\n", b"PAR1", b"TDSm", b"\x93NUMPY\x01\x00", b"PK\x03\x04")
)
CONTENTS = st.one_of(st.tuples(HEADS, st.binary(max_size=300)).map(b"".join), TABLES, CURRENTS)
WORDS = st.one_of(
    NUMBERS,
    st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=8),
    st.binary(max_size=4).map(lambda octets: os.fsdecode(octets.replace(b"\0", b""))),
    st.sampled_from(("nan", "inf", "-1", "../..", "2026-02-30", "a=b")),
)


def _value(drawn: st.DrawFn, folder: Path, number: int) -> str:
    """Draw a word, or make a file and name it."""
    if drawn(st.booleans()):
        return drawn(WORDS)
    path = folder / f"junk{number}{drawn(st.sampled_from(SUFFIXES))}"
    path.write_bytes(drawn(CONTENTS))
    return str(path)


@st.composite
def _arguments(draw: st.DrawFn, command: typer.core.TyperCommand, folder: Path) -> list[str]:
    words: list[str] = []
    for number, parameter in enumerate(command.params):
        if parameter.name == "url":
            words += ["--url", NOWHERE]
        elif isinstance(parameter, typer.core.TyperArgument):
            words.append(_value(draw, folder, number))
        elif parameter.name == "as_json" or (not parameter.required and draw(st.integers(0, 3))):
            continue
        elif getattr(parameter, "is_flag", False):
            words.append(parameter.opts[0])
        else:
            words.append(f"{parameter.opts[0]}={_value(draw, folder, number)}")
    return words


def _told(capsys: pytest.CaptureFixture[str], words: Sequence[str], *, in_json: bool) -> None:
    code = main([*words, "--json"] if in_json else words)
    shown = capsys.readouterr()
    told = shown.err[-2_000:]
    assert code in (0, 1, 2)
    assert "a defect of mcc" not in told, told
    assert "Traceback" not in told, told
    if in_json:
        assert isinstance(json.loads(shown.out), dict | list)


@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_ends_with_a_word_on_any_junk(
    words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    command = COMMANDS[words]
    in_json = any("--json" in parameter.opts for parameter in command.params)
    monkeypatch.chdir(tmp_path)

    @settings(
        max_examples=4,
        phases=[Phase.generate],
        derandomize=True,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        database=None,
    )
    @given(_arguments(command, tmp_path))
    def ends(arguments: list[str]) -> None:
        monkeypatch.setattr("sys.stdin", io.StringIO(""))
        _told(capsys, [*words.split()[1:], *arguments], in_json=in_json)

    ends()
