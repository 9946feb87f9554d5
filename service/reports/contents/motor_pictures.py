"""The pictures of a motor's report."""

from collections.abc import Sequence

from core.machines.parameters import Motor
from service.condition.shown_records import asymmetry_of_records, load_points, supply_points
from service.pictures.asymmetry import asymmetry_picture
from service.pictures.load import load_picture
from service.pictures.load_profile import LoadShare, load_profile_picture
from service.pictures.phasors import Phasor, phasor_picture
from service.pictures.supply import supply_picture
from service.pictures.trend import MOST_MARKS, TrendMark, TrendPoint, trend_picture
from service.reports.document import Block, Column, ColumnKind, Picture, Table
from service.reports.motors import ReportedMotor
from service.storage.records.history import SeenRecord

EVENTS = (
    Column("no.", ColumnKind.WHOLE, 0.4),
    Column("time", ColumnKind.TIME, 1.5),
    Column("event", width=5.0),
)
PEAK_TO_RMS = 2**-0.5


def motor_pictures(
    motor: ReportedMotor,
    seen: Sequence[SeenRecord],
    data: Motor | None,
    events: Sequence[tuple[int, str]],
    until_ns: int,
    zone: str,
) -> Sequence[Block]:
    """Return the pictures in their blocks. data: of the motors file; None where it is not known.

    events: times with what happened, oldest first.
    """
    limit = None if data is None else data.limits.fault_level
    shown = _within(events, seen, until_ns)
    pictures = [
        _trend(motor, seen, limit, shown, until_ns, zone),
    ]
    trend: list[Picture | Table] = [*pictures]
    if shown:
        rows = [(number, *event) for number, event in enumerate(shown, start=1)]
        trend.append(Table("events", EVENTS, rows))
    return [
        Block("Fault level over time", trend),
        Block(
            "What the records show",
            [*_asymmetry(motor, seen, data), *_latest(motor, seen), *_of_records(motor, seen, limit)],
        ),
    ]


def _trend(
    motor: ReportedMotor,
    seen: Sequence[SeenRecord],
    limit: float | None,
    events: Sequence[tuple[int, str]],
    until_ns: int,
    zone: str,
) -> Picture:
    points = [
        TrendPoint(
            one.observation.time_ns,
            one.figures.mu_f,
            one.figures.mu_f_ci95_low,
            one.figures.mu_f_ci95_high,
            one.figures.state.value,
        )
        for one in seen
        if one.figures is not None and one.figures.mu_f is not None
    ]
    svg = trend_picture(
        motor.name,
        points,
        limit=limit,
        ahead=motor.ahead,
        detectable=motor.detectable,
        until_ns=until_ns,
        marks=[TrendMark(*event) for event in events],
        zone=zone,
    )
    return Picture(svg, f"The latest {len(points)} records, with the 95 % interval of the level.")


def _within(
    events: Sequence[tuple[int, str]], seen: Sequence[SeenRecord], until_ns: int
) -> Sequence[tuple[int, str]]:
    """Return the events that the trend shows, numbered as it does."""
    if not seen:
        return []
    first_ns = seen[0].observation.time_ns
    return [event for event in events if first_ns <= event[0] <= until_ns][-MOST_MARKS:]


def _asymmetry(motor: ReportedMotor, seen: Sequence[SeenRecord], data: Motor | None) -> Sequence[Picture]:
    """Return the picture of the asymmetry by phase; none where the motor's figures are not known."""
    if data is None:
        return []
    shown = asymmetry_of_records(
        seen,
        data,
        since_ns=motor.since_ns,
        detectable=motor.detectable,
        state=motor.said.state.value,
    )
    words = (
        "Each dot is what one record shows by itself, as the shorted turns that would look the same. "
        "The arrows are means of the dots before the change and since it."
    )
    return [Picture(asymmetry_picture(motor.name, shown), words, 0.42)]


def _latest(motor: ReportedMotor, seen: Sequence[SeenRecord]) -> Sequence[Picture]:
    if not seen:
        return []
    svg = phasor_picture(f"{motor.name}: latest record", _phasors(seen[-1]))
    return [Picture(svg, "Sequence components of the windings in the latest record, rms.", 0.58)]


def _of_records(motor: ReportedMotor, seen: Sequence[SeenRecord], limit: float | None) -> Sequence[Picture]:
    by_load = load_points(seen)
    loads = [one.observation.load_level for one in seen]
    shares = [LoadShare(load) for load in loads if load is not None]
    return [
        Picture(
            supply_picture(motor.name, supply_points(seen)),
            "The lines are those of NEMA MG-1, 12.45 and 14.36.",
            0.5,
        ),
        Picture(load_picture(motor.name, by_load, limit=limit), "The level as it was told then.", 0.5),
        Picture(load_profile_picture(motor.name, shares), "Shares of the records, not of the time.", 0.5),
    ]


def _phasors(one: SeenRecord) -> Sequence[Phasor]:
    seen = one.observation
    reference = seen.positive_voltage_V
    turn = PEAK_TO_RMS * (abs(reference) / reference if reference else 1.0)
    return [
        Phasor("V1", seen.positive_voltage_V * turn, "V"),
        Phasor("V2", seen.negative_voltage_V * turn, "V"),
        Phasor("I1", seen.positive_current_A * turn, "A"),
        Phasor("I2", seen.negative_current_A * turn, "A"),
    ]
