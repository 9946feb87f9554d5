"""How far the broker has been told what happened. It outlives the gateway."""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import NamedTuple

from service.gateways.kept_file import KeptFileError, read_kept, write_kept

POSITION = "mqtt-position.json"
WINDOW = 200
"""So many numbers back it is looked for changes of alarms that turned up later than others."""


class Place(NamedTuple):
    """Time of the latest changes of a motor's condition that were told, and their ids."""

    time_ns: int
    ids: tuple[str, ...] = ()


class Position:
    """What has been told; `save` is called once the broker has it.

    conditions: by motor.
    """

    def __init__(self, data_directory: Path) -> None:
        """Raises KeptFileError."""
        self._file = data_directory / POSITION
        found = read_kept(self._file)
        self.is_new = found is None
        self._alarms: set[int] = set()
        self.conditions: dict[str, Place] = {}
        if found is not None:
            try:
                self._alarms = set(map(_number, _list(found["alarms"])))
                self.conditions = {str(name): _place(one) for name, one in _items(found["conditions"])}
            except (KeyError, TypeError, ValueError) as error:
                raise KeptFileError(
                    f"{self._file}: expected what was told to the broker, found another document"
                ) from error

    @property
    def alarms_after(self) -> int:
        """Return beyond which number changes of alarms may not have been told."""
        return max(self._alarms, default=0) - WINDOW

    def begin(self, sequences: Collection[int], conditions: Mapping[str, Place]) -> None:
        """Begin now: what has happened before is not told."""
        self._alarms = set(sequences)
        self.conditions = dict(conditions)
        self.is_new = False
        self.save()

    def untold(self, sequences: Collection[int]) -> list[int]:
        """Return which of these changes of alarms have not been told."""
        return sorted(set(sequences) - self._alarms)

    def told(self, sequences: Collection[int]) -> None:
        """Note that these changes of alarms have been told."""
        self._alarms.update(sequences)
        self._alarms = {one for one in self._alarms if one > self.alarms_after}

    def save(self) -> None:
        """Keep it. Raises OSError."""
        write_kept(
            self._file,
            {"alarms": sorted(self._alarms), "conditions": self.conditions},
        )


def _number(found: object) -> int:
    if not isinstance(found, int) or isinstance(found, bool):
        raise TypeError(found)
    return found


def _list(found: object) -> list[object]:
    if not isinstance(found, list):
        raise TypeError(found)
    return found


def _items(found: object) -> Collection[tuple[object, object]]:
    if not isinstance(found, dict):
        raise TypeError(found)
    return found.items()


def _place(found: object) -> Place:
    time_ns, ids = _list(found)
    return Place(_number(time_ns), tuple(map(str, _list(ids))))
