"""A plant of many motors in a database, whose conditions can be changed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from core.units import NANOSECONDS_PER_SECOND
from service.plant import Plant, PlantMotor, Site
from service.storage import Repository, connect
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.database import make_database
from testing.service.plants import motor, relay


@dataclass(frozen=True, slots=True)
class ChangingPlant:
    """The plant, and the time at which its conditions were first told."""

    repository: Repository
    motors: Sequence[str]
    now_ns: int

    def change(self, name: str, number: int) -> None:
        """Let a motor be faulty or healthy in turns, and later each time."""
        now_ns = self.now_ns + (number + 1) * NANOSECONDS_PER_SECOND
        condition = FAULT if number % 2 == 0 else HEALTHY
        tell(self.repository, replace(condition, motor=name, as_of_ns=now_ns), now_ns=now_ns)


def changing_plant(directory: Path, motors: int, *, now_ns: int) -> ChangingPlant:
    """Return a plant of so many healthy motors, each behind a relay of its own."""
    numbers = range(1, motors + 1)
    plant = Plant(
        sites=(Site("WORKS", "Works"),),
        relays=tuple(relay(f"R{number:04d}", "WORKS", 10_000 + number) for number in numbers),
        motors=tuple(
            PlantMotor(motor(f"MOTOR-{number:04d}"), f"Motor {number}", "WORKS", f"R{number:04d}")
            for number in numbers
        ),
    )
    repository = Repository(connect(make_database(directory)))
    repository.sync_plant(plant)
    names = [one.name for one in plant.motors]
    for name in names:
        tell(repository, replace(HEALTHY, motor=name, as_of_ns=now_ns), now_ns=now_ns)
    return ChangingPlant(repository, names, now_ns)
