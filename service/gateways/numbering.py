"""Numbers of motors for protocols that know no names. A motor keeps its number for good."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from service.gateways.kept_file import KeptFileError, read_kept, write_kept


class MotorNumbers:
    """Numbers from 0 on, kept in a file of the data directory.

    A motor that is new gets the lowest number that none ever had. A motor that is gone keeps its own: what
    other systems have been told to read must not become another motor.
    """

    def __init__(self, file: Path) -> None:
        """Raises KeptFileError."""
        self._file = file
        self._numbers = _read(file)

    def of(self, motors: Iterable[str]) -> Mapping[str, int]:
        """Return the numbers of all motors that ever were, with these. Raises OSError."""
        new = sorted(set(motors) - self._numbers.keys())
        if new:
            first = max(self._numbers.values(), default=-1) + 1
            numbers = {**self._numbers, **{motor: first + place for place, motor in enumerate(new)}}
            write_kept(self._file, numbers)
            self._numbers = numbers
        return self._numbers


def _read(file: Path) -> dict[str, int]:
    found = read_kept(file) or {}
    numbers = {
        motor: number
        for motor, number in found.items()
        if isinstance(number, int) and not isinstance(number, bool) and number >= 0
    }
    if len(numbers) < len(found) or len(set(numbers.values())) < len(numbers):
        raise KeptFileError(f"{file}: expected a table of motors with a number each, found another one")
    return numbers
