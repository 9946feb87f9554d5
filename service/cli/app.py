"""`mcc`: its commands put together, and how one of them is run."""

import sys
from collections.abc import Callable, Sequence
from functools import cache
from importlib.metadata import version
from io import TextIOWrapper
from typing import Annotated

import typer

from core.error_words import one_line
from core.machines.compile_watch import watched
from service.cli.commands import (
    access,
    alarms,
    audit,
    backups,
    data_sheets,
    exports,
    inspections,
    notifications,
    plant_files,
    programs,
    record_files,
    reports,
    service,
    stored,
)
from service.cli.compilation import CompilationBar
from service.cli.output import DONE, FAILED, WRONG_USE, CommandError, defect, print_failure

app = typer.Typer(
    name="mcc",
    help="Stator condition of every induction motor in a plant, from the relays it already has.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

INTERRUPTED = 130
"""Typer ends with this exit code after Ctrl-C."""


def _print_version(wanted: bool) -> None:
    if wanted:
        sys.stdout.write(f"mcc {version('statorwatch')}\n")
        raise typer.Exit


@app.callback()
def options(
    *,
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and stop."),
    ] = False,
) -> None:
    """Read the options that come before a command."""


_PARTS = (
    programs,
    access,
    record_files,
    data_sheets,
    service,
    stored,
    alarms,
    notifications,
    inspections,
    exports,
    reports,
    plant_files,
    backups,
    audit,
)
for _part in _PARTS:
    app.add_typer(_part.commands)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. Returns 0 done, 1 failed, 2 wrong use."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if isinstance(sys.stdout, TextIOWrapper):  # names of files may be no text, which JSON escapes alike
        sys.stdout.reconfigure(errors="backslashreplace")
    # The demo's --json names a file, which the command writes itself.
    in_json = "--json" in words and words[0] != "demo"
    try:
        with watched(CompilationBar()):
            return _run(words, in_json=in_json)
    except Exception as error:  # noqa: BLE001  whatever a command did not expect is told, and is a defect
        print_failure(defect(error), in_json=in_json)
        return FAILED


@cache
def _program() -> Callable[..., object]:
    return typer.main.get_command(app)


def _run(words: Sequence[str], *, in_json: bool) -> int:
    try:
        outcome = _program()(words, prog_name="mcc", standalone_mode=False)
    except CommandError as error:
        print_failure(error, in_json=in_json)
        return error.exit_code
    except UnicodeEncodeError as error:  # of a word that the shell gave in no encoding of text
        failure = CommandError(f"expected words in UTF-8, found {error.object!r}", details={"type": "NoText"})
        print_failure(failure, in_json=in_json)
        return WRONG_USE
    except typer.TyperException as error:
        message = one_line(error.format_message()) or "expected a command"
        context = getattr(error, "ctx", None)
        command = "mcc" if context is None else context.command_path
        failure = CommandError(f"{message} ({command} --help tells the way)", details={"type": "WrongUse"})
        print_failure(failure, in_json=in_json)
        return WRONG_USE
    if outcome == INTERRUPTED:
        print_failure(CommandError("interrupted", details={"type": "Interrupted"}), in_json=in_json)
        return FAILED
    return outcome if isinstance(outcome, int) else DONE
