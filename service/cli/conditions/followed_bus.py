"""Other motors of the bus whose records `mcc follow` is given: MOTOR.toml=RECORDS."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from core.condition.bus.bus_records import BusRecords
from core.condition.bus.neighbours import StandingEstimate
from core.condition.errors import ObservationError
from core.condition.following.follower import Follower
from core.machines.motor_file.reader import read_motor
from core.machines.parameters import Motor
from service.cli.conditions.followed_records import Seen, find_records
from service.cli.output import WRONG_USE, CommandError


@dataclass(frozen=True, slots=True)
class Member:
    """A motor of a bus, with its records."""

    motor: Motor
    seen: Sequence[Seen]

    @property
    def used(self) -> int:
        """Number of its records that are of use."""
        return sum(one.observation is not None for one in self.seen)

    def as_dict(self) -> dict[str, object]:
        """Return the member as a document."""
        return {"motor": self.motor.name, "records": self.used, "skipped": len(self.seen) - self.used}


@dataclass(frozen=True, slots=True)
class Bus:
    """What the other motors of a bus tell of one: their records, and their standing asymmetries."""

    others: Sequence[Member]
    records: BusRecords
    standings: Sequence[StandingEstimate]


def read_neighbours(
    words: Sequence[str], motor: Motor, observe: Callable[[Sequence[Path], Motor], Sequence[Seen]]
) -> list[Member]:
    """Return the motors that MOTOR.toml=RECORDS name; the same one may be given several times.

    Raises CommandError (wrong use) for what is not of that form, MotorFileError for a motor's file.
    """
    given: dict[Path, list[str]] = {}
    for word in words:
        file, _, records = word.partition("=")
        if not file or not records:
            raise _wrong(word, "MOTOR.toml=RECORDS", "no = between two names")
        given.setdefault(Path(file), []).append(records)
    found: list[Member] = []
    for path, records_of in given.items():
        other = read_motor(path)
        if other.name in (motor.name, *(one.motor.name for one in found)):
            raise _wrong(str(path), "files of other names, which are the motors' names", other.name)
        found.append(Member(other, observe(find_records(records_of), other)))
    return found


def bus_of(own: Member, others: Sequence[Member]) -> Bus:
    """Follow the other motors of the bus, each beside all the rest."""
    everyone = [own, *others]
    standings = (_standing(other, _records_beside(other, everyone)) for other in others)
    return Bus(others, _records_beside(own, everyone), [one for one in standings if one is not None])


def _records_beside(member: Member, everyone: Sequence[Member]) -> BusRecords:
    return BusRecords(
        (other.motor, one.observation)
        for other in everyone
        if other is not member
        for one in other.seen
        if one.observation is not None
    )


def _standing(member: Member, beside: BusRecords) -> StandingEstimate | None:
    follower = Follower(member.motor)
    for one in member.seen:
        if one.observation is not None:
            try:
                follower.fold(one.observation, beside.neighbours(one.observation.time_ns))
            except ObservationError:
                # A record that cannot be folded tells nothing; of the motor that is followed it is listed.
                continue
    return follower.standing_estimate()


def _wrong(word: str, expected: str, found: str) -> CommandError:
    return CommandError(
        f"--neighbour {word}: expected {expected}, found {found}",
        details={"type": "NeighbourUnusable", "expected": expected, "found": found},
        exit_code=WRONG_USE,
    )
