"""A figure of a motor, declared: its name, unit and meaning, of what it tells, and how it is written."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final


class Subject(StrEnum):
    """Of what a figure tells. All but CONDITION and PARAMETERS are of one record by itself."""

    STATOR = "stator"
    """The winding, and the load that the fit finds with it."""
    CONDITION = "condition"
    """The winding, as all records up to one tell it."""
    ROTOR = "rotor"
    AIR_GAP = "air gap"
    LOAD = "load"
    """Swings of the load's torque."""
    SUPPLY = "supply"
    LOSSES = "losses"
    PARAMETERS = "parameters"
    """Changes of the machine's parameters, as all records up to one tell them."""


class Role(StrEnum):
    """What a figure is to the one that it belongs to."""

    VALUE = "value"
    CI95_LOW = "lower end of the 95 % interval"
    CI95_HIGH = "upper end of the 95 % interval"
    SCATTER95_LOW = "lower end of the scatter"
    SCATTER95_HIGH = "upper end of the scatter"
    DETECTION_LIMIT = "detection limit"
    STANDARD_DEVIATION = "standard deviation"
    MARGIN = "half of the 95 % interval"


INTERVAL_ENDS: Final = frozenset({Role.CI95_LOW, Role.CI95_HIGH, Role.SCATTER95_LOW, Role.SCATTER95_HIGH})


@dataclass(frozen=True, slots=True)
class Quantity:
    """A figure, or a word, that records of a motor tell.

    Parameters
    ----------
    name : str
        In trends, exports and commands.
    subject : Subject
        Of what it tells.
    unit : str
        "1" for a ratio, "" for a word.
    meaning : str
        In one sentence without its period.
    attribute : str
        Where it stands in the finding of its subject.
    of : str or None
        Name of the figure that it belongs to, as an end of an interval does; None for a figure by itself.
    role : Role
        What it is to that one.
    written : str
        How people read it: a format specification, "%" for a share in percent, "" for a word.
    """

    name: str
    subject: Subject
    unit: str
    meaning: str
    attribute: str
    of: str | None = None
    role: Role = Role.VALUE
    written: str = ".4g"

    def read(self, finding: object) -> Any:
        """Return its value in a finding of its subject.

        Parameters
        ----------
        finding : object
            The finding, which has it as an attribute; the ends of an interval as one of the two together.

        Returns
        -------
        object
            The value; None where the finding does not tell it.
        """
        if self.end is None:
            return getattr(finding, self.attribute)
        interval, place = self.end
        ends = getattr(finding, interval)
        return None if ends is None else ends[place]

    @property
    def end(self) -> tuple[str, int] | None:
        """The attribute of the interval whose end it is, and which of the two; None of other figures."""
        for place, suffix in enumerate(("_low", "_high")):
            if self.role in INTERVAL_ENDS and self.attribute.endswith(suffix):
                return self.attribute.removesuffix(suffix), place
        return None

    @property
    def is_trended(self) -> bool:
        """Whether it has a trend of its own: a number, with its interval beside it."""
        return self.role is Role.VALUE and not self.is_word

    @property
    def is_word(self) -> bool:
        """Whether it is a word."""
        return not self.written

    @property
    def is_whole(self) -> bool:
        """Whether it is a whole number."""
        return self.written == "d"

    @property
    def is_in_percent(self) -> bool:
        """Whether people read it in percent."""
        return self.written == "%"
