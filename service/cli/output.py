"""What a command leaves behind: results on stdout, everything else on stderr, errors as one clear line."""

import json
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from rich.console import Console

DONE, FAILED, WRONG_USE = 0, 1, 2

UNLIMITED_WIDTH = 10_000
"""Columns. Tables take what they need of it."""

DETAILS = ("path", "source", "host", "operation", "line", "element", "field", "expected", "found")
"""Attributes of the project's errors that tell a program where to look."""


class CommandError(Exception):
    """A command could not do what it was asked. `details` are the error's fields, for --json."""

    def __init__(
        self, message: str, *, details: Mapping[str, object] | None = None, exit_code: int = FAILED
    ) -> None:
        super().__init__(message)
        self.details = dict(details or {})
        self.exit_code = exit_code

    @classmethod
    def from_error(cls, error: Exception, exit_code: int = FAILED) -> "CommandError":
        """The same failure, with whatever fields the error carries."""
        details: dict[str, object] = {"type": type(error).__name__}
        for name in DETAILS:
            value = getattr(error, name, None)
            if value is not None:
                details[name] = value if isinstance(value, int) else str(value)
        message = one_line(str(error) or type(error).__name__)
        return cls(message, details=details, exit_code=exit_code)


@contextmanager
def failing_clearly(*expected: type[Exception], exit_code: int = FAILED) -> Iterator[None]:
    """Turn the errors a command expects into its one line; anything else is a bug and keeps its traceback."""
    try:
        yield
    except expected as error:
        raise CommandError.from_error(error, exit_code) from error


def one_line(text: str) -> str:
    """Text from files and relays may hold line ends and control characters; a line in a log holds none."""
    return "".join(character if character.isprintable() else " " for character in text).strip()


def results() -> Console:
    """Where a person reads the results.

    A terminal sets the width. A file or a pipe has none, and a figure cut off there is a figure lost.
    """
    width = None if sys.stdout.isatty() else UNLIMITED_WIDTH
    return Console(file=sys.stdout, highlight=False, width=width)


def progress() -> Console:
    """Where a person follows what goes on."""
    return Console(file=sys.stderr, highlight=False)


def print_document(document: object) -> None:
    """One JSON document on stdout."""
    sys.stdout.write(as_json(document) + "\n")


def print_failure(error: CommandError, *, in_json: bool) -> None:
    """One line on stderr and, where asked for, the same as one JSON document on stdout."""
    sys.stderr.write(f"mcc: {error}\n")
    if in_json:
        print_document(failure_document(error))


def print_warning(text: str) -> None:
    """One line on stderr; the command goes on."""
    sys.stderr.write(f"mcc: warning: {one_line(text)}\n")


def failure_document(error: CommandError) -> dict[str, object]:
    """The shape of every failure in JSON."""
    return {"error": {"message": str(error), **error.details}}


def as_json(document: object) -> str:
    """Strict JSON: a NaN in a result is a bug to see here, not at the reader's."""
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
