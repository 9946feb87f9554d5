"""The error of a motor's table that cannot be used."""

from collections.abc import Sequence
from pathlib import Path


class MotorFileError(ValueError):
    """The error of a motor's table that cannot be used.

    It says which file, which field, what was expected and what was found.

    Parameters
    ----------
    source : pathlib.Path or str
        Name of the file, for messages.
    field : str
        Field at fault.
    expected : str
        What was expected, in words.
    found : str
        What was found, in words.
    nearest : str, optional
        What was probably meant.
    others : sequence of MotorFileError
        What else is wrong in the table. The text of this error does not tell it.
    """

    def __init__(
        self,
        source: Path | str,
        field: str,
        *,
        expected: str,
        found: str,
        nearest: str | None = None,
        others: Sequence["MotorFileError"] = (),
    ) -> None:
        self.source = str(source)
        self.field = field
        self.expected = expected
        self.found = found
        self.nearest = nearest
        self.others = tuple(others)
        meant = "" if nearest is None else f" (did you mean {nearest}?)"
        super().__init__(f"{self.source}: {field}: expected {expected}, found {found}{meant}")

    def with_nearest(self, nearest: str | None) -> "MotorFileError":
        """Return the same error with what was probably meant.

        Parameters
        ----------
        nearest : str or None
            What was probably meant.

        Returns
        -------
        MotorFileError
            The error.
        """
        return self._copy(nearest, self.others)

    def with_others(self, others: Sequence["MotorFileError"]) -> "MotorFileError":
        """Return the same error as the first of several.

        Parameters
        ----------
        others : sequence of MotorFileError
            The further ones.

        Returns
        -------
        MotorFileError
            The error.
        """
        return self._copy(self.nearest, others)

    def _copy(self, nearest: str | None, others: Sequence["MotorFileError"]) -> "MotorFileError":
        return MotorFileError(
            self.source,
            self.field,
            expected=self.expected,
            found=self.found,
            nearest=nearest,
            others=others,
        )
