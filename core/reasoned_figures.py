"""What figures of a record have in common: they are told, or reasons say why they are not."""

from dataclasses import dataclass, field, fields
from typing import Any, Self


@dataclass(frozen=True, slots=True)
class ReasonedFigures:
    """Figures of a record, with their reasons.

    Parameters
    ----------
    reasons : tuple of str
        What limits the figures, in words.
    """

    reasons: tuple[str, ...] = field(kw_only=True)

    @classmethod
    def untold(cls, reason: str) -> Self:
        """Return the figures of a record that tells nothing.

        Parameters
        ----------
        reason : str
            Why, in words.

        Returns
        -------
        ReasonedFigures
            Without figures.
        """
        untold: dict[str, Any] = {one.name: None for one in fields(cls)}
        return cls(**untold | {"reasons": (reason,)})

    def as_dict(self) -> dict[str, object]:
        """Return the part of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name, and the reasons after them; tuples are lists.
        """
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        values["reasons"] = values.pop("reasons")
        return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}
