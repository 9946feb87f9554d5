"""Starts that somebody has to look after: hard ones, and changes of the latest ones; what is to be done."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from core.starts.compared import Change, ChangeState, Quantity, StartCause, StartChanges
from core.time_stamps import SECONDS_END, rfc3339

LATEST: Final = 3
"""Latest starts that are taken together, to tell a small change from the scatter of single ones."""
LEAST_CHANGED: Final = 2
"""Starts after those of the reference that a change is told from: a single one may have been hindered."""
HEAT: Final = 0.9
"""Share of the rotor's limit from which on a start is a hard one."""
HALF: Final = 0.5
"""Share of the change of the latest starts from which on an earlier one has changed, too."""

ADVICE: Final[Mapping[StartCause, str]] = {
    StartCause.LOAD: (
        "Check what the motor drives: bearings, gear, belt, a valve or damper that should be closed while it "
        "starts; where the load became less, coupling and pump."
    ),
    StartCause.SUPPLY: (
        "Check the voltage while it starts: joints of the feeder, taps of the transformer, and what else "
        "starts at that time."
    ),
    StartCause.ROTOR: (
        "Look at the trend of the rotor on the motor's page, start the motor as seldom as possible, and have "
        "the rotor inspected at the next planned stop."
    ),
}
HARD_STARTS_ADVICE: Final = (
    "Let the motor cool before the next start, find out who or what starts it so often or so long, and "
    "compare the relay's limits of starts with the motor's data sheet."
)
NOT_TOLD_APART: Final = (
    "Have further starts recorded from rest to speed with all voltages, and check the coupling and what the "
    "motor drives."
)


@dataclass(frozen=True, slots=True)
class StartSeen:
    """How hard a start was.

    Parameters
    ----------
    time_ns : int
        When it was, UTC [ns].
    within_hour : int
        Starts in the hour that ends with it.
    allowed : int or None
        How many the motor file allows; None where it says nothing.
    heat : float or None
        I2t over what the rotor withstands, from running temperature where that is known.
    limit_source : str, optional
        Where that limit comes from.
    """

    time_ns: int
    within_hour: int
    allowed: int | None
    heat: float | None
    limit_source: str = ""

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why it is a hard one; empty where it is not."""
        when, found = _when(self.time_ns), []
        if self.allowed is not None and self.within_hour > self.allowed:
            found.append(
                f"{self.within_hour} starts in the hour up to {when}, and {self.allowed} are allowed"
            )
        if self.heat is not None and self.heat >= HEAT:
            found.append(
                f"the start of {when} brought {100.0 * self.heat:.0f} % of the heat that the rotor "
                f"withstands ({self.limit_source})"
            )
        return tuple(found)


@dataclass(frozen=True, slots=True)
class NotableChange:
    """A change of starts that somebody has to look after.

    Parameters
    ----------
    causes : tuple of StartCause
        Its causes; empty where they are not told apart.
    changes : StartChanges
        The comparison.
    """

    causes: tuple[StartCause, ...]
    changes: StartChanges

    @property
    def advice(self) -> str:
        """What is to be done."""
        return " ".join(ADVICE[cause] for cause in self.causes) or NOT_TOLD_APART

    def reason(self, since_ns: int, *, or_earlier: bool) -> str:
        """Return what has changed, why, and since which start.

        Parameters
        ----------
        since_ns : int
            When the first start was that shows it, UTC [ns].
        or_earlier : bool
            Whether it may be an earlier one.

        Returns
        -------
        str
            In words.
        """
        since = f"since the start of {_when(since_ns)}{' or earlier' if or_earlier else ''}"
        causes = " and ".join(cause.words for cause in self.causes) or "not told apart why"
        return "; ".join([f"{causes}, {since}", *self.changes.reasons])

    def is_seen_in(self, single: StartChanges) -> bool:
        """Return whether a single start shows at least half of the change, the same way.

        Parameters
        ----------
        single : StartChanges
            The start, compared alone.

        Returns
        -------
        bool
            Whether it does.
        """
        told = {one.quantity: one for one in self.changes.changes if _counts(one)}
        return any(
            one.quantity in told and one.change / told[one.quantity].change >= HALF for one in single.changes
        )


def notable_change(found: StartChanges | None, starts: int) -> NotableChange | None:
    """Return what has changed in the latest starts.

    Warm windings are no fault, nor is a supply that is stronger, or weaker without starts that take longer:
    hours beyond its limits tell that.

    Parameters
    ----------
    found : StartChanges or None
        The latest starts compared with the first ones; None without any.
    starts : int
        How many were taken together.

    Returns
    -------
    NotableChange or None
        The change; None for nothing that somebody has to look after.
    """
    if found is None or starts < LEAST_CHANGED:
        return None
    changes = {one.quantity: one for one in found.changes}
    time, voltage = changes.get(Quantity.ACCELERATION), changes.get(Quantity.VOLTAGE)
    is_longer = time is not None and time.is_told and time.change > 0.0
    is_weaker = voltage is not None and voltage.is_told and voltage.change < 0.0
    causes = tuple(
        cause
        for cause in found.causes
        if cause in (StartCause.LOAD, StartCause.ROTOR)
        or (cause is StartCause.SUPPLY and is_longer and is_weaker)
    )
    if causes or (found.state is ChangeState.NOT_TOLD_APART and is_longer):
        return NotableChange(causes, found)
    return None


def hard_starts(latest: Sequence[StartSeen]) -> Sequence[StartSeen]:
    """Return the starts that were hard ones.

    Parameters
    ----------
    latest : sequence of StartSeen
        A motor's starts, latest first.

    Returns
    -------
    sequence of StartSeen
        Those of the latest three that were hard.
    """
    return [one for one in latest[:LATEST] if one.reasons]


def _counts(change: Change) -> bool:
    return change.is_told and change.quantity is not Quantity.WARMTH


def _when(time_ns: int) -> str:
    return f"{rfc3339(time_ns)[:SECONDS_END]}Z"
