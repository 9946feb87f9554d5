"""One table of a motor's file: typed values, and errors that name the key. Every error is kept."""

from collections.abc import Mapping
from enum import StrEnum
from math import inf, isnan, nan
from pathlib import Path
from typing import TypeVar

from core.error_words import nearest, shown
from core.machines.motor_file.error import MotorFileError
from core.machines.parameters import ParametersSource
from core.quantity_text import plain

Word = TypeVar("Word", bound=StrEnum)

ROUNDING = 1e-6
"""A value may lie so far beyond its ends, relatively: files have seven digits of it."""

TRANSFORMER_RATIOS = (1e-4, 1e5)
"""Also of clip-on sensors whose volts or millivolts the recording calls amperes, and of kV called V."""

LARGEST = 1e300
"""Beyond are numbers that a computer cannot hold."""

NOTHING = "nothing"
UNKNOWN = "an unknown key"


class MotorTable:
    """One table of the file. A value that cannot be used is an error, and nan or a default stands for it.

    Parameters
    ----------
    tables : mapping of str to object
        All tables of the motor.
    name : str
        Name of this one.
    source : pathlib.Path or str
        Where the tables come from, for messages.
    errors : list of MotorFileError
        Gets the errors.
    optional : bool
        Whether the table may be missing.
    """

    def __init__(
        self,
        tables: Mapping[str, object],
        name: str,
        source: Path | str,
        errors: list[MotorFileError],
        *,
        optional: bool = False,
    ) -> None:
        self._name, self._source, self._errors = name, source, errors
        self._known: set[str] = set()
        self._values: Mapping[str, object] = {}
        values = tables.get(name, {} if optional else None)
        if isinstance(values, Mapping):
            self._values = values
        else:
            found = NOTHING if values is None else type(values).__name__
            errors.append(MotorFileError(source, f"[{name}]", expected="a table", found=found))
        self.is_there = isinstance(values, Mapping)
        self.is_empty = not self._values

    @property
    def has_errors(self) -> bool:
        """Whether a value of the table was refused."""
        return any(error.field.startswith(f"[{self._name}]") for error in self._errors)

    def number(
        self,
        key: str,
        ends: tuple[float, float],
        expected: str = "",
        *,
        unit: str = "",
        default: float | None = None,
    ) -> float:
        """Take a number above zero between two ends.

        Parameters
        ----------
        key : str
            Key of the value.
        ends : tuple of float
            Least and largest value. Ends that are not known (nan) are not looked at.
        expected : str, optional
            The ends in words.
        unit : str, optional
            Unit of the value, where `expected` does not tell it.
        default : float, optional
            Value where the table has none.

        Returns
        -------
        float
            The number, nan in place of one that was refused.
        """
        value = self._take(key, default)
        low, high = ends
        expected = expected or f"{plain(low, 6)} to {plain(high, 6)} {unit}"
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < inf:
            self._refuse(
                key, "a number above zero" if isnan(low) else f"a number above zero, {expected}", value
            )
            return nan
        if value < low * (1.0 - ROUNDING) or value > high * (1.0 + ROUNDING):
            self._refuse(key, expected, value)
            return nan
        try:
            return float(value)
        except OverflowError:  # where the ends are not known
            return nan

    def optional_number(self, key: str, ends: tuple[float, float], *, unit: str) -> float | None:
        """Take a number above zero that may be missing.

        Parameters
        ----------
        key : str
            Key of the value.
        ends : tuple of float
            Least and largest value.
        unit : str
            Unit of the value.

        Returns
        -------
        float or None
            The number, None where there is none.
        """
        return None if self._take(key, None) is None else self.number(key, ends, unit=unit)

    def ratio(self, key: str) -> float | None:
        """Take a ratio of transformers.

        Parameters
        ----------
        key : str
            Key of the value.

        Returns
        -------
        float or None
            The ratio, None where there is none.
        """
        if self._take(key, None) is None:
            return None
        expected = "primary over secondary value such as 60 for 6600:110, or 1 where the values are primary"
        return self.number(key, TRANSFORMER_RATIOS, expected)

    def phase_numbers(self, key: str) -> tuple[float, float, float] | None:
        """Take one number for all phases, or three.

        Parameters
        ----------
        key : str
            Key of the value.

        Returns
        -------
        tuple of float or None
            The numbers of phases a, b, c; None where the table has none.
        """
        value = self._take(key, None)
        if value is None:
            return None
        given: list[object] = value if isinstance(value, list) else [value] * 3
        numbers = [
            one
            for one in given
            if isinstance(one, int | float) and not isinstance(one, bool) and abs(one) <= LARGEST
        ]
        if len(given) != 3 or len(numbers) != 3:
            self._refuse(key, "a number, or three for phases a, b, c", value)
            return None
        return float(numbers[0]), float(numbers[1]), float(numbers[2])

    def interval(self, key: str) -> tuple[float, float] | None:
        """Take an interval.

        Parameters
        ----------
        key : str
            Key of the value.

        Returns
        -------
        tuple of float or None
            Low and high end, None where there are none.
        """
        value = self._take(key, None)
        if value is None:
            return None
        if (
            not isinstance(value, list)
            or len(value) != 2
            or any(isinstance(end, bool) or not isinstance(end, int | float) for end in value)
            or not 0.0 < value[0] <= value[1] < inf
        ):
            self._refuse(key, "[low, high], two numbers above zero", value)
            return None
        try:
            return float(value[0]), float(value[1])
        except OverflowError:
            self._refuse(key, "numbers that a computer can hold", value)
            return None

    def count(self, key: str, most: int) -> int:
        """Take a whole number from 1 on.

        Parameters
        ----------
        key : str
            Key of the value.
        most : int
            Largest number.

        Returns
        -------
        int
            The number, 1 in place of one that was refused.
        """
        value = self._take(key, None)
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= most:
            self._refuse(key, f"a whole number of 1 to {most}", value)
            return 1
        return value

    def optional_count(self, key: str, most: int) -> int | None:
        """Take a whole number from 1 on that may be missing.

        Parameters
        ----------
        key : str
            Key of the value.
        most : int
            Largest number.

        Returns
        -------
        int or None
            The number, None where there is none.
        """
        return None if self._take(key, None) is None else self.count(key, most)

    def word(self, key: str, usual: Word, *, required: bool = False) -> Word:
        """Take one of several words.

        Parameters
        ----------
        key : str
            Key of the value.
        usual : StrEnum
            Word where the table has none, and in place of one that was refused.
        required : bool, default False
            Whether the table must have one.

        Returns
        -------
        StrEnum
            The word.
        """
        value = self._take(key, None if required else usual.value)
        words = type(usual)
        try:
            return words(str(value))
        except ValueError:
            self._refuse(key, " or ".join(f'"{word}"' for word in words), value)
            return usual

    def span(self, key: str, most: float, unit: str) -> tuple[float, float]:
        """Take a number, or the least and the largest that it may be, from zero on.

        Parameters
        ----------
        key : str
            Key of the value.
        most : float
            Largest number; one that is not known (nan) is not looked at.
        unit : str
            Unit of the value.

        Returns
        -------
        tuple of float
            Least and largest; zero by default.
        """
        value = self._take(key, 0.0)
        given: list[object] = value if isinstance(value, list) else [value, value]
        numbers = [end for end in given if isinstance(end, int | float) and not isinstance(end, bool)]
        ends = [float(end) for end in numbers if 0.0 <= end < LARGEST]
        if len(given) != 2 or len(ends) != 2 or ends[0] > ends[1] or ends[1] > most * (1.0 + ROUNDING):
            limit = "" if isnan(most) else f", 0 to {plain(most, 6)} {unit}"
            self._refuse(key, f"a number, or [least, largest]{limit}", value)
            return 0.0, 0.0
        return ends[0], ends[1]

    def refuse_all(self, keys: tuple[str, ...], expected: str) -> None:
        """Refuse keys that have no place here, wherever they are given.

        Parameters
        ----------
        keys : tuple of str
            The keys.
        expected : str
            Where they belong.
        """
        for key in keys:
            if (value := self._take(key, None)) is not None:
                self._refuse(key, expected, value)

    def refuse(self, key: str, expected: str, found: object) -> None:
        """Refuse a value that was taken, for what another key says.

        Parameters
        ----------
        key : str
            Key of the value.
        expected : str
            What was expected, in words.
        found : object
            The value.
        """
        self._refuse(key, expected, found)

    def source(self, key: str, default: ParametersSource) -> ParametersSource:
        """Take where the parameters come from.

        Parameters
        ----------
        key : str
            Key of the value.
        default : ParametersSource
            Source where the table tells none.

        Returns
        -------
        ParametersSource
            The source.
        """
        value = self._take(key, default.value)
        try:
            return ParametersSource(str(value))
        except ValueError:
            self._refuse(key, f"one of {', '.join(ParametersSource)}", value)
            return default

    def names(self, *keys: str) -> tuple[str, str, str] | None:
        """Take the names of three channels.

        Parameters
        ----------
        *keys : str
            Their keys.

        Returns
        -------
        tuple of str or None
            The names, None where the table has none of them.
        """
        self._known.update(keys)
        if not any(key in self._values for key in keys):
            return None
        first, second, third = (self._name_of(key) for key in keys)
        return first, second, third

    def end(self) -> None:
        """Tell of the keys that nobody asked for. A misspelt key is not told as missing too."""
        for key in sorted(set(self._values) - self._known):
            near = nearest(key, self._known)
            missing = f"[{self._name}] {near}"
            self._errors[:] = [
                error for error in self._errors if (error.field, error.found) != (missing, NOTHING)
            ]
            self._errors.append(
                MotorFileError(
                    self._source,
                    f"[{self._name}] {key}",
                    expected=f"one of {', '.join(sorted(self._known))}",
                    found=UNKNOWN,
                    nearest=near,
                )
            )

    def _name_of(self, key: str) -> str:
        value = self._take(key, None)
        if isinstance(value, str) and value:
            return value
        self._refuse(key, "a channel name", value)
        return ""

    def _take(self, key: str, default: object) -> object:
        self._known.add(key)
        return self._values.get(key, default)

    def _refuse(self, key: str, expected: str, found: object) -> None:
        in_words = NOTHING if found is None else shown(found)
        self._errors.append(
            MotorFileError(self._source, f"[{self._name}] {key}", expected=expected, found=in_words)
        )
