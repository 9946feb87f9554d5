"""The pictures of a motor's pages: its asymmetry by phase, its level against load, and its supply."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from markupsafe import Markup

from core.machines.parameters import Motor
from service.api.conditions.schemas import Condition
from service.condition.shown_records import asymmetry_of_records, load_points, supply_points
from service.pictures.asymmetry import asymmetry_picture
from service.pictures.load import load_picture
from service.pictures.looks import PAGE, Look
from service.pictures.supply import supply_picture
from service.storage import Repository
from service.storage.records.history import SeenRecord
from service.web.motor.picture_tables import (
    PictureTables,
    asymmetry_table,
    load_table,
    supply_table,
)
from service.web.motor.time_range import TimeRange
from service.web.pictures import markup

MOST_RECORDS: Final = 240
"""The latest records that the pictures show."""


@dataclass(frozen=True, slots=True)
class MotorDrawings:
    """Pictures as SVG. tables: the values behind them."""

    asymmetry: Markup
    load: Markup
    supply: Markup
    tables: PictureTables


def motor_drawings(
    repository: Repository,
    motor: Motor,
    condition: Condition,
    since_ns: int | None,
    shown: TimeRange,
    *,
    look: Look = PAGE,
) -> MotorDrawings:
    """Draw what a motor's latest records show. since_ns: first record of a change; None without one."""
    latest = repository.latest_records(motor.name, limit=MOST_RECORDS)
    seen = [one for one in latest if shown.has(one.observation.time_ns)]
    earlier: Sequence[SeenRecord] = ()
    if since_ns is not None and seen and seen[0].observation.time_ns >= since_ns:
        earlier = repository.latest_records(motor.name, limit=MOST_RECORDS // 2, before_ns=since_ns)
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
        tables=PictureTables(asymmetry_table(found), load_table(loads), supply_table(supply)),
    )
