"""Tables of the motors file: values of the expected type, and problems that name the key."""

from collections.abc import Callable
from pathlib import Path

from core.error_words import nearest, shown
from service.configuration.problems import Problem, Problems
from service.plant.schedule import Schedule

LONGEST_TEXT = 200
ONLY_RUNNING = "schedule_only_running"


class PlantTable:
    """One table of the motors file.

    What is taken from it is known, and `end` tells of the rest. A value that cannot be used is told to the
    problems and counts as if it were not there.
    """

    def __init__(
        self,
        values: dict[str, object],
        whose: str,
        path: Path,
        problems: Problems,
        line: Callable[..., int | None],
    ) -> None:
        """Begin with all that tomllib read of the table.

        line: returns the line of a key of the table, given by its path.
        """
        self.is_sound = True
        self.path = path
        self._values, self._whose, self._problems = values, whose, problems
        self._line = line
        self._known = ["name"]

    def text(self, key: str, expected: str) -> str | None:
        """Return a short printable text; None where the table has none."""
        value = self.take(key)
        if isinstance(value, str) and is_text(value):
            return value
        if value is not None:
            self.refuse(key, expected, value)
        return None

    def flag(self, key: str, expected: str) -> bool:
        """Return true or false, which is the default."""
        value = self.take(key)
        if value is not None and not isinstance(value, bool):
            self.refuse(key, expected, value)
        return value is True

    def number(self, key: str, least: float, most: float, meaning: str) -> float | None:
        """Return a number within bounds; None where the table has none."""
        value = self.take(key)
        if isinstance(value, int | float) and not isinstance(value, bool) and least <= value <= most:
            return float(value)
        if value is not None:
            self.refuse(key, f"{meaning}, {least:g} to {most:g}", value)
        return None

    def schedule(self) -> Schedule | None:
        """Return when something is recorded; None where the table does not say."""
        expression = self.take("schedule")
        only_running = self.flag(
            ONLY_RUNNING, "true (a motor that stands when it is due is not recorded) or false"
        )
        if expression is None:
            if only_running:
                self.refuse(ONLY_RUNNING, 'a schedule beside it, such as schedule = "30 6 * * MON"', None)
            return None
        try:
            return Schedule.parse(
                expression if isinstance(expression, str) else "", only_running=only_running
            )
        except ValueError as error:
            self.refuse("schedule", str(error), expression)
            return None

    def take(self, key: str) -> object:
        """Take whatever the table has under a key; None where it has nothing."""
        self._known.append(key)
        return self._values.pop(key, None)

    @property
    def keys(self) -> tuple[str, ...]:
        """Return the keys that were looked for so far."""
        return tuple(self._known)

    def rest(self) -> dict[str, object]:
        """Take all that was not taken yet."""
        rest, self._values = self._values, {}
        return rest

    def end(self) -> None:
        """Tell of the keys that nobody took."""
        for key in self._values:
            self.tell(
                key,
                expected=f"one of {', '.join(self._known)}",
                found="an unknown key",
                nearest=nearest(key, self._known),
            )

    def refuse(self, key: str, expected: str, value: object, nearest: str | None = None) -> None:
        """Tell that the value of a key cannot be used."""
        self.tell(key, expected=expected, found="none" if value is None else shown(value), nearest=nearest)

    def tell(self, key: str, *, expected: str, found: str, nearest: str | None = None) -> None:
        """Tell of a problem with a key."""
        self.is_sound = False
        line = self._line(*key.split("."))
        field = f"{self._whose}: {key}"
        self._problems.add(Problem(str(self.path), field, expected, found, nearest, line))


def is_text(text: str) -> bool:
    """Tell whether a text is printable, and of a bearable length."""
    return text.isprintable() and 0 < len(text.strip()) <= LONGEST_TEXT
