"""What the pages of starts show, read from the repository."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from markupsafe import Markup

from core.starts.compared import StartChanges
from core.starts.notable import LATEST
from service.api.pages import decode, encode
from service.pictures.looks import PAGE, Look
from service.pictures.starts import StartLine, starts_picture
from service.storage import Repository
from service.storage.records import ConditionEvent, StartEntry
from service.web.addresses import address
from service.web.pictures import markup

OVERLAID: Final = 10
"""The latest starts that are drawn over one another."""
MOST_LISTED: Final = 50
MOST_OF_MOTOR: Final = 8
"""Below the pictures of a motor's starts."""


@dataclass(frozen=True, slots=True)
class ComparedStart:
    """A start beside the reference of its motor.

    longer: acceleration time over that of the reference, less 1.  hotter: the same of the I2t; both None
    where that cannot be told.  changes: why it is other than the first starts; None for those.  within_hour:
    starts in the hour that ends with it.
    """

    entry: StartEntry
    longer: float | None = None
    hotter: float | None = None
    is_reference: bool = False
    changes: StartChanges | None = None
    within_hour: int = 1

    @property
    def too_often(self) -> bool:
        """Whether there were more starts within an hour than the motor file allows."""
        stress = self.entry.filled.stress
        allowed = None if stress is None else stress.starts_per_hour
        return allowed is not None and self.within_hour > allowed


@dataclass(frozen=True, slots=True)
class StartsOfMotor:
    """The starts of a motor. current, voltage: pictures as SVG; voltage is None where no start has any.

    renewed: what made the reference begin anew; None where nothing did.  changes: why the latest starts,
    taken together, are other than the first ones; None where there are no others.
    """

    starts: Sequence[ComparedStart]
    next_path: str | None
    reference: StartEntry | None
    renewed: ConditionEvent | None
    current: Markup
    voltage: Markup | None
    torque: Markup | None
    changes: StartChanges | None
    drawn: int


@dataclass(frozen=True, slots=True)
class AllStarts:
    """The latest starts of all motors."""

    starts: Sequence[StartEntry]
    next_path: str | None


def starts_of_motor(
    repository: Repository, motor: str, cursor: str | None, *, look: Look = PAGE
) -> StartsOfMotor:
    """Read what the page of a motor's starts shows. Raises NotFoundError, ProblemError."""
    page = repository.starts(motor, limit=MOST_OF_MOTOR, after=decode(cursor, int, str))
    first_ones = repository.start_reference(motor)
    reference = first_ones.starts[0] if first_ones.starts else None
    counts = repository.starts_within_hour(page.items)
    latest = page.items if cursor is None else repository.starts(motor, limit=OVERLAID).items
    drawn = [one for one in latest[:OVERLAID] if one.start.is_from_rest and one != reference]
    drawn.reverse()
    lines = [current_line(one) for one in drawn]
    volts = [line for line in map(voltage_line, drawn) if line is not None]
    first = None if reference is None else current_line(reference)
    first_volts = None if reference is None else voltage_line(reference)
    return StartsOfMotor(
        starts=[
            replace(
                compared(one, reference),
                changes=first_ones.compared([one]),
                within_hour=counts[one.recording_id],
            )
            for one in page.items
        ],
        next_path=None
        if page.next is None
        else address("/motors", motor, "starts", cursor=encode(page.next)),
        reference=reference,
        renewed=first_ones.renewed,
        current=markup(starts_picture(motor, lines, reference=first, look=look)),
        voltage=_voltage(motor, volts, first_volts, look),
        torque=_torque(motor, drawn, reference, look),
        changes=first_ones.compared(latest[:LATEST]),
        drawn=len(drawn),
    )


def _voltage(
    motor: str, lines: Sequence[StartLine], reference: StartLine | None, look: Look
) -> Markup | None:
    if not lines and reference is None:
        return None
    return markup(starts_picture(motor, lines, reference=reference, unit="V", name="voltage", look=look))


def _torque(
    motor: str, drawn: Sequence[StartEntry], reference: StartEntry | None, look: Look
) -> Markup | None:
    lines = [line for line in map(torque_line, drawn) if line is not None]
    first = None if reference is None else torque_line(reference)
    if not lines and first is None:
        return None
    return markup(starts_picture(motor, lines, reference=first, unit="N m", name="torque", look=look))


def all_starts(repository: Repository, cursor: str | None) -> AllStarts:
    """Read what the page of all starts shows. Raises ProblemError."""
    page = repository.starts(limit=MOST_LISTED, after=decode(cursor, int, str))
    further = None if page.next is None else address("/starts", cursor=encode(page.next))
    return AllStarts(page.items, further)


def compared(entry: StartEntry, reference: StartEntry | None) -> ComparedStart:
    """Return a start beside the reference. A part of a start tells nothing of how long a whole one takes."""
    if reference is None or entry.recording_id == reference.recording_id:
        return ComparedStart(entry, is_reference=reference is not None)
    if entry.source is not reference.source:
        return ComparedStart(entry)
    mine, first = entry.start, reference.start
    is_whole = mine.acceleration_s is not None
    return ComparedStart(
        entry,
        longer=_more(mine.acceleration_s, first.acceleration_s),
        hotter=_more(mine.i2t_A2s, first.i2t_A2s) if is_whole else None,
    )


def current_line(entry: StartEntry) -> StartLine:
    """Return the current of a start as it is drawn."""
    start = entry.start
    return StartLine(start.curve.first_s, start.curve.step_s, start.curve.current_A, start.acceleration_s)


def voltage_line(entry: StartEntry) -> StartLine | None:
    """Return the voltage of a start as it is drawn; None where none was recorded."""
    start = entry.start
    if start.curve.voltage_V is None:
        return None
    return StartLine(start.curve.first_s, start.curve.step_s, start.curve.voltage_V, start.acceleration_s)


def torque_line(entry: StartEntry) -> StartLine | None:
    """Return the torque of a start as it is drawn; None where it is not known."""
    torque = entry.examined.torque
    if torque is None:
        return None
    return StartLine(torque.first_s, torque.step_s, torque.torque_Nm, entry.start.acceleration_s)


def _more(value: float | None, first: float | None) -> float | None:
    return None if value is None or not first else value / first - 1.0
