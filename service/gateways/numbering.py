"""Numbers of motors for protocols that know no names. A motor keeps its number for good."""

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path


class NumberingError(RuntimeError):
    """The file with the numbers cannot be used; it says why."""


class MotorNumbers:
    """Numbers from 0 on, kept in a file of the data directory.

    A motor that is new gets the lowest number that none ever had. A motor that is gone keeps its own: what
    other systems have been told to read must not become another motor.
    """

    def __init__(self, file: Path) -> None:
        """Raises NumberingError."""
        self._file = file
        self._numbers = _read(file)

    def of(self, motors: Iterable[str]) -> Mapping[str, int]:
        """Return the numbers of all motors that ever were, with these. Raises OSError."""
        new = sorted(set(motors) - self._numbers.keys())
        if new:
            first = max(self._numbers.values(), default=-1) + 1
            numbers = {**self._numbers, **{motor: first + place for place, motor in enumerate(new)}}
            self._write(numbers)
            self._numbers = numbers
        return self._numbers

    def _write(self, numbers: Mapping[str, int]) -> None:
        """Replace the file at once: a reader, or a crash, sees the old or the new one."""
        written = self._file.with_suffix(".new")
        with written.open("w", encoding="utf-8") as output:
            json.dump(numbers, output, ensure_ascii=False, indent=1)
            output.flush()
            os.fsync(output.fileno())
        written.replace(self._file)


def _read(file: Path) -> dict[str, int]:
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise NumberingError(f"{file}: expected the numbers of the motors, found: {error}") from error
    is_right = isinstance(found, dict) and all(
        isinstance(number, int) and not isinstance(number, bool) and number >= 0 for number in found.values()
    )
    if not is_right or len(set(found.values())) != len(found):
        raise NumberingError(f"{file}: expected a table of motors with a number each, found another document")
    return dict(found)
