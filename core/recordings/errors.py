"""Errors of the record readers: which file, which field, what was expected."""

from pathlib import Path


class RecordingError(ValueError):
    """The error of a recording that cannot be read as it is; nothing of it was repaired or guessed.

    `expected` and `found` say why in words that a person can act on.

    Parameters
    ----------
    path : pathlib.Path or str
        File at fault.
    field : str
        Place in it, such as "line 2, channel counts".
    expected : str
        What was expected, in words.
    found : str
        What was found, in words.
    """

    def __init__(self, path: Path | str, field: str, *, expected: str, found: str) -> None:
        self.path = Path(path)
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{self.path.name}: {field}: expected {expected}, found {found}")

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (self.path, self.field, self.expected, self.found)


class RecordingTooLongError(RecordingError):
    """The error of a recording that is sound as far as it was read, but longer than the caller wants it."""


class UnknownTimeError(RecordingError):
    """The error of a recording whose time is asked for and which has none."""


def _rebuild(path: Path, field: str, expected: str, found: str) -> RecordingError:
    return RecordingError(path, field, expected=expected, found=found)


def quoted(text: str) -> str:
    """Return text from a file as a message shows it: short and without control characters.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    str
        What is shown.
    """
    return repr(text if len(text) <= 60 else text[:57] + "...")
