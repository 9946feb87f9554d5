"""Every import, every name of a module and every command that a page tells is there."""

import ast
import importlib
import io
import re
import shlex
from collections.abc import Iterator
from functools import reduce
from pathlib import Path

import pytest

from service.cli.app import main
from tests.docs.command_reference import commands
from tests.docs.pages import ROOT, pages

PACKAGES = "core|scl|mms|ied_sim|service|statorwatch_client|testing|benchmarks|tests|examples"
NAME = re.compile(rf"`((?:{PACKAGES})(?:\.[A-Za-z_]\w*)+)(?:\([^`]*\))?`")
PYTHON = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(r"^(?: {4,}|)(?:\$ )?((?:mcc|ied-sim) [^\n]*)$", re.MULTILINE)
FENCED = re.compile(r"^```(?:sh|bash|console|)\n(.*?)^```", re.MULTILINE | re.DOTALL)
KNOWN = dict(commands())
PAGES = {str(page.relative_to(ROOT)): page for page in pages()}


def text_of(page: str) -> str:
    return PAGES[page].read_text(encoding="utf-8")


def found(name: str) -> object:
    """Import the longest part of a dotted name that is a module, and take the rest from it."""
    words = name.split(".")
    for length in range(len(words), 0, -1):
        try:
            module = importlib.import_module(".".join(words[:length]))
        except ModuleNotFoundError:
            continue
        return reduce(getattr, words[length:], module)
    raise ModuleNotFoundError(name)


def imports(code: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Import):
            yield from (one.name for one in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{one.name}" for one in node.names)


@pytest.mark.parametrize("page", PAGES)
def test_modules_and_imports_are_there(page: str) -> None:
    text = text_of(page)
    names = {name for name in NAME.findall(text) if not Path(ROOT, name.replace(".", "/", 1)).is_file()}
    for code in PYTHON.findall(text):
        names.update(imports(code))
    for name in sorted(names):
        found(name)


def told_commands(text: str) -> Iterator[list[str]]:
    indented = "\n".join(line for line in text.splitlines() if line.startswith("    "))
    for part in (indented, *FENCED.findall(text)):
        for line in COMMAND.findall(part.replace("\\\n", " ")):
            try:
                yield shlex.split(line, comments=True)
            except ValueError:  # goes on in the next line
                continue


@pytest.mark.parametrize("page", PAGES)
def test_commands_and_their_options_are_there(page: str) -> None:
    for words in told_commands(text_of(page)):
        name = next((" ".join(words[:n]) for n in (3, 2, 1) if " ".join(words[:n]) in KNOWN), None)
        if name is None:
            assert words[1:2] in (["--help"], ["--version"]) or any(
                one.startswith(" ".join(words[:2])) for one in KNOWN
            ), words
            continue
        known = {
            option
            for parameter in KNOWN[name].params
            for option in (*parameter.opts, *parameter.secondary_opts)
        }
        given = {word.partition("=")[0].strip("[]") for word in words if word.strip("[").startswith("--")}
        assert given <= known | {"--help"}, (name, given - known)


SERVING = frozenset({"serve", "collect", "work", "demo"})
"""Commands that run until they are ended; tests of their own start them, as they do `ied-sim`."""
OF_SHELL = frozenset({"|", "||", ">", ">>", "&&", "&", ";"})
SYNOPSIS = re.compile(r"[\[<]|\.\.\.|\bNAME\b")


def run_commands() -> Iterator[tuple[str, ...]]:
    """Yield each command of the pages that ends by itself, once, without what a shell does afterwards."""
    seen = set[tuple[str, ...]]()
    for page in PAGES:
        for words in told_commands(text_of(page)):
            end = next(
                (n for n, word in enumerate(words) if word in {"|", "||", ">", ">>", "&&", "&", ";"}), None
            )
            command = tuple(words[:end])
            is_one = command[0] == "mcc" and command[1:2] and command[1] not in SERVING
            if is_one and not SYNOPSIS.search(" ".join(command)) and command not in seen:
                seen.add(command)
                yield command


@pytest.mark.parametrize("command", [*run_commands()], ids=" ".join)
def test_each_command_runs_as_it_is_written(
    command: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """It does its work, or says in words what is missing here, as the service: it is never used wrongly."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("MCC_URL", "http://127.0.0.1:9")
    monkeypatch.setattr("sys.stdin", io.StringIO())
    code = main(command[1:])
    said = capsys.readouterr()
    assert code in (0, 1, 2)
    assert not re.search(r"tells the way|defect|Traceback", said.err + said.out)
    assert code == 0 or (said.err + said.out).strip()
