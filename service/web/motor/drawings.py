"""The pictures of a motor's page: its asymmetry by phase, level against load, supply, and load profile."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from markupsafe import Markup

from core.machines.parameters import Motor
from core.units import NANOSECONDS_PER_DAY
from service.api.conditions.schemas import Condition
from service.condition.shown_records import asymmetry_of_records, load_points, supply_points
from service.pictures.asymmetry import asymmetry_picture
from service.pictures.load import load_picture
from service.pictures.load_profile import LoadShare, load_profile_picture
from service.pictures.looks import PAGE, Look
from service.pictures.supply import supply_picture
from service.storage import Repository
from service.storage.records.history import SeenRecord
from service.web.motor.picture_tables import (
    PictureTables,
    asymmetry_table,
    load_table,
    profile_table,
    supply_table,
)
from service.web.pictures import markup

MOST_RECORDS: Final = 240
"""The latest records that the pictures show."""
PROFILE_DAYS: Final = 90


@dataclass(frozen=True, slots=True)
class MotorDrawings:
    """Pictures as SVG. tables: the values behind them.  records: how many they show.

    profile_of: what the load profile is made of.
    """

    asymmetry: Markup
    load: Markup
    supply: Markup
    profile: Markup
    tables: PictureTables
    records: int
    profile_of: str


def motor_drawings(
    repository: Repository,
    motor: Motor,
    condition: Condition,
    since_ns: int | None,
    now_ns: int,
    *,
    look: Look = PAGE,
) -> MotorDrawings:
    """Draw what a motor's latest records show. since_ns: first record of a change; None without one."""
    seen = repository.latest_records(motor.name, limit=MOST_RECORDS)
    earlier: Sequence[SeenRecord] = ()
    if since_ns is not None and seen and seen[0].observation.time_ns >= since_ns:
        earlier = repository.latest_records(motor.name, limit=MOST_RECORDS // 2, before_ns=since_ns)
    shares, profile_of = load_shares(repository, motor, seen, now_ns)
    limit = motor.limits.fault_level
    found = asymmetry_of_records(
        [*earlier, *seen],
        motor,
        since_ns=since_ns,
        detectable=condition.reference.detectable,
        state=condition.state.value,
    )
    supply, loads = supply_points(seen), load_points(seen)
    return MotorDrawings(
        asymmetry=markup(asymmetry_picture(motor.name, found, look=look)),
        load=markup(load_picture(motor.name, loads, limit=limit, look=look)),
        supply=markup(supply_picture(motor.name, supply, look=look)),
        profile=markup(load_profile_picture(motor.name, shares, of_what=profile_of, look=look)),
        tables=PictureTables(
            asymmetry_table(found), load_table(loads), supply_table(supply), profile_table(shares, profile_of)
        ),
        records=len(seen),
        profile_of=profile_of,
    )


def load_shares(
    repository: Repository, motor: Motor, seen: Sequence[SeenRecord], now_ns: int
) -> tuple[list[LoadShare], str]:
    """Return how loaded the motor is, by the power that its relay measures, or else by its records.

    The power is that taken from the supply, over the rated one of the shaft.
    """
    rated_W = motor.nameplate.rated_power_W
    from_ns = now_ns - PROFILE_DAYS * NANOSECONDS_PER_DAY
    measured = repository.power_profile(motor.name, step_W=0.05 * rated_W, from_ns=from_ns)
    if measured:
        shares = [LoadShare(abs(power_W) / rated_W, quarters) for power_W, quarters in measured]
        return shares, f"of the time in {PROFILE_DAYS} days"
    loads = [one.observation.load_level for one in seen]
    return [LoadShare(load) for load in loads if load is not None], "of the records"
