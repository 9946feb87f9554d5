"""What a command prints: results on stdout, everything else on stderr, an error as one line."""

import json
import os
import sys
import traceback
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console, RenderableType
from rich.text import Text

from core.error_words import one_line
from service.client.tables import FittedTable
from service.configuration.problems import ConfigurationError

DONE, FAILED, WRONG_USE = 0, 1, 2

PIPED_WIDTH = 80
"""A table has so many columns in a file or a pipe, where the variable COLUMNS says nothing."""

LEAST_WIDTH = 40

READABLE_WIDTH = 100
"""Longer texts in a table are wrapped, however wide the terminal."""

DETAILS = ("path", "source", "host", "operation", "line", "element", "field", "expected", "found")
"""These attributes of the project's errors tell a program where to look."""


class CommandError(Exception):
    """A command could not do its work. details: the fields of the error, for --json."""

    def __init__(
        self, message: str, *, details: Mapping[str, object] | None = None, exit_code: int = FAILED
    ) -> None:
        super().__init__(message)
        self.details = dict(details or {})
        self.exit_code = exit_code

    @classmethod
    def from_error(cls, error: Exception, exit_code: int = FAILED) -> "CommandError":
        """Return the same failure with the fields of the error."""
        details: dict[str, object] = {"type": type(error).__name__}
        for name in DETAILS:
            value = getattr(error, name, None)
            if value is not None:
                details[name] = value if isinstance(value, int) else str(value)
        message = "\n".join(map(one_line, str(error).splitlines())) or type(error).__name__
        if isinstance(error, ConfigurationError):
            details["problems"] = [problem.document() for problem in error.problems]
        else:
            message = one_line(message)
        return cls(message, details=details, exit_code=exit_code)


def defect(error: Exception) -> CommandError:
    """Return what a command says of an error that nobody expected: a defect of ours, and where it is."""
    inner = traceback.extract_tb(error.__traceback__)
    places = [f"{Path(frame.filename).name}, line {frame.lineno}" for frame in inner[-2:]]
    return CommandError(
        f"a defect of mcc: {type(error).__name__}: {one_line(str(error))} ({'; '.join(places)}): please "
        "report it with the command and its files",
        details={"type": "Defect", "error": type(error).__name__, "places": places},
    )


@contextmanager
def failing_clearly(*expected: type[Exception], exit_code: int = FAILED) -> Iterator[None]:
    """Turn expected errors into CommandError. Any other error is a defect, which `main` tells as such."""
    try:
        yield
    except expected as error:
        raise CommandError.from_error(error, exit_code) from error


def results() -> Console:
    """Return the console of the results: as wide as the terminal, or as COLUMNS says."""
    columns = os.environ.get("COLUMNS", "")
    width = max(int(columns), LEAST_WIDTH) if columns.isdecimal() and len(columns) < 6 else None
    if width is None and not sys.stdout.isatty():
        width = PIPED_WIDTH
    return Console(file=sys.stdout, highlight=False, width=width)


def facts_table(*parts: Iterable[tuple[str, RenderableType]], title: str | None = None) -> FittedTable:
    """Return a table of names with what they are; a line between the parts. With a title it has a frame."""
    table = FittedTable(title=None if title is None else Text(title), title_justify="left", show_header=False)
    if title is None:
        table.box, table.padding = None, (0, 2, 0, 0)
    table.add_column(no_wrap=True)
    table.add_column(max_width=READABLE_WIDTH)
    for part in parts:
        for name, value in part:
            table.add_row(name, value)
        table.add_section()
    return table


def progress() -> Console:
    """Return the console of progress messages."""
    return Console(file=sys.stderr, highlight=False)


def print_document(document: object) -> None:
    """Print one JSON document on stdout."""
    sys.stdout.write(as_json(document) + "\n")


def print_failure(error: CommandError, *, in_json: bool) -> None:
    """Print a line for each problem on stderr and, if `in_json`, the same as one JSON document on stdout."""
    sys.stderr.writelines(f"mcc: {line}\n" for line in str(error).splitlines())
    if in_json:
        print_document(failure_document(error))


def print_warning(text: str) -> None:
    """Print one line on stderr."""
    sys.stderr.write(f"mcc: warning: {one_line(text)}\n")


def failure_document(error: CommandError) -> dict[str, object]:
    """Return a failure as a JSON document."""
    return {"error": {"message": str(error), **error.details}}


def as_json(document: object) -> str:
    """Return strict JSON. Raises ValueError for NaN, which is a bug of whoever made the document."""
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
