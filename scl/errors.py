"""What a configuration file got wrong, and where."""

from dataclasses import dataclass
from pathlib import Path


class SclError(ValueError):
    """A configuration file, or a part of it, cannot be used; nothing of it was repaired or guessed.

    Parameters
    ----------
    path : pathlib.Path or str
        The file.
    expected : str
        What should be there, in words a person can act on.
    found : str
        What is there.
    line : int, optional
        Line in the file; None where no line is at fault.
    element : str
        XML element as it stands there (`<LN lnType="RDRE1">`).
    """

    def __init__(
        self, path: Path | str, *, expected: str, found: str, line: int | None = None, element: str = ""
    ) -> None:
        self.path = Path(path)
        self.line = line
        self.element = element
        self.expected = expected
        self.found = found
        where = [self.path.name, f"line {line}" if line is not None else "", element]
        super().__init__(f"{': '.join(filter(None, where))}: expected {expected}, found {found}")

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (self.path, self.expected, self.found, self.line, self.element)


def _rebuild(path: Path, expected: str, found: str, line: int | None, element: str) -> SclError:
    return SclError(path, expected=expected, found=found, line=line, element=element)


@dataclass(frozen=True, slots=True)
class Finding:
    """Something odd in a file that is clear enough to be used all the same.

    Parameters
    ----------
    line : int
        Line in the file.
    element : str
        XML element as it stands there, shortened.
    message : str
        What is odd.
    left_out : bool
        Whether the element, or what the message says of it, is missing from what was read.
    """

    line: int
    element: str
    message: str
    left_out: bool = False

    def __str__(self) -> str:
        return f"line {self.line}: {self.element}: {self.message}"
