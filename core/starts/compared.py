"""What has changed from earlier starts of a motor to later ones."""

from dataclasses import dataclass
from enum import StrEnum

from core.starts.examined import Interval


class Quantity(StrEnum):
    """A figure by which starts are compared."""

    ACCELERATION = "acceleration"
    VOLTAGE = "voltage"
    LOAD = "load"
    ROTOR = "rotor"
    WARMTH = "warmth"


class StartCause(StrEnum):
    """Why starts are other than they were."""

    SUPPLY = "supply"
    LOAD = "load"
    ROTOR = "rotor"
    WARMTH = "warmth"
    """Windings warmer or colder than in the reference: no fault."""

    @property
    def words(self) -> str:
        """The cause in words."""
        return f"the {self.value}"


class ChangeState(StrEnum):
    """What a comparison says."""

    AS_BEFORE = "as-before"
    CHANGED = "changed"
    NOT_TOLD_APART = "not-told-apart"
    """The starts take another time, and no cause is told."""
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Change:
    """Change of one figure.

    Parameters
    ----------
    quantity : Quantity
        The figure.
    value, reference : float
        Its mean, and that of the reference: time [s], voltage [V], load torque over the rated one, R_r' over
        R_s (or [ohm]), R_s [ohm].
    change : float
        Difference as a share of the reference; of the load, of the rated torque.
    ci95 : tuple of float
        95 % interval of the change.
    relevant : float
        Changes below this are not told.
    """

    quantity: Quantity
    value: float
    reference: float
    change: float
    ci95: Interval
    relevant: float

    @property
    def is_told(self) -> bool:
        """Whether the change is certain and large enough to be told."""
        low, high = self.ci95
        return abs(self.change) >= self.relevant and not low <= 0.0 <= high

    @property
    def may_be_relevant(self) -> bool:
        """Whether the interval holds a change that would be told."""
        return max(abs(end) for end in self.ci95) >= self.relevant

    @property
    def words(self) -> str:
        """The change in words, with its interval."""
        low, high = (f"{100.0 * end:+.0f}" for end in self.ci95)
        figures = f"{100.0 * self.change:+.0f} % [{low}..{high}]"
        match self.quantity:
            case Quantity.ACCELERATION:
                return f"the run-up takes {self.value:.3g} s, {figures}"
            case Quantity.VOLTAGE:
                return f"the voltage of the run-up is {figures}"
            case Quantity.LOAD:
                return f"the load takes {self.value:.0%} of the rated torque while starting, {figures}"
            case Quantity.ROTOR:
                return f"the rotor's resistance, its warmth taken out, is {figures}"
            case Quantity.WARMTH:
                state = "warmer" if self.change > 0.0 else "colder"
                return f"the windings are {state}: the stator's resistance is {figures}"


@dataclass(frozen=True, slots=True)
class StartChanges:
    """Comparison of starts with those of the reference.

    Parameters
    ----------
    state : ChangeState
        What the comparison says.
    causes : tuple of StartCause
        Causes that are told.
    possible : tuple of StartCause
        Causes that are not told apart, where the starts take another time.
    changes : tuple of Change
        What is known of each figure.
    voltage_effect, load_effect : tuple of float or None
        By how much the change of voltage, or of load, alone makes the run-up longer: ends of the 95 %
        interval, as shares; None where not known.
    reasons : tuple of str
        The changes in words.
    """

    state: ChangeState
    causes: tuple[StartCause, ...]
    possible: tuple[StartCause, ...]
    changes: tuple[Change, ...]
    voltage_effect: Interval | None
    load_effect: Interval | None
    reasons: tuple[str, ...]

    @classmethod
    def unknown(cls, reason: str) -> "StartChanges":
        """Return the comparison that cannot be made.

        Parameters
        ----------
        reason : str
            Why.

        Returns
        -------
        StartChanges
            It.
        """
        return cls(ChangeState.UNKNOWN, (), (), (), None, None, (reason,))

    def as_dict(self) -> dict[str, object]:
        """Return the comparison as JSON takes it.

        Returns
        -------
        dict of str to object
            The document.
        """
        return {
            "state": str(self.state),
            "causes": [str(one) for one in self.causes],
            "possible": [str(one) for one in self.possible],
            "changes": {
                str(one.quantity): {
                    "value": one.value,
                    "reference": one.reference,
                    "change": one.change,
                    "ci95": list(one.ci95),
                }
                for one in self.changes
            },
            "voltage_effect": None if self.voltage_effect is None else list(self.voltage_effect),
            "load_effect": None if self.load_effect is None else list(self.load_effect),
            "reasons": list(self.reasons),
        }
