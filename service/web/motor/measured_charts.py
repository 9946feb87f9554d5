"""Current, voltage, power and load of a motor over time, beside its fault level."""

from collections.abc import Sequence
from typing import Final

from core.machines.parameters import Motor
from core.motor_condition.supply import VOLTAGE_DEVIATION
from core.thermal.full_load import full_load_current_A
from service.plant import AveragingStep, MeteredQuantity
from service.storage import Repository
from service.storage.records import Measurement
from service.web.charts import AxisKind, Band, Chart, Kind, Limit, Series, Tone
from service.web.motor.time_range import TimeRange, in_seconds
from service.web.motor.trend import HEIGHT, SYNC

PIECES: Final = 240
"""Of the time shown, each with its mean."""
MINUTES_UP_TO_DAYS: Final = 2.0
MOST_RECORDS: Final = 400
KILO: Final = 1000.0
PERCENT: Final = 100.0
DIGITS: Final = 4
PHASES: Final = (Tone.A, Tone.B, Tone.C)
CURRENTS: Final = (MeteredQuantity.IA, MeteredQuantity.IB, MeteredQuantity.IC)
LINE_VOLTAGES: Final = (MeteredQuantity.VAB, MeteredQuantity.VBC, MeteredQuantity.VCA)
PHASE_VOLTAGES: Final = (MeteredQuantity.VA, MeteredQuantity.VB, MeteredQuantity.VC)


def measured_charts(
    repository: Repository, name: str, motor: Motor | None, shown: TimeRange
) -> tuple[Chart, ...]:
    """Return the charts of which anything was measured, or recorded, in the time shown."""
    course = _course(repository, name, shown)
    found = (
        _current(name, course, motor, shown),
        _voltage(name, course, motor, shown),
        _power(name, course, shown),
        _load(repository, name, shown),
    )
    return tuple(one for one in found if one is not None)


def _course(repository: Repository, name: str, shown: TimeRange) -> Sequence[Measurement]:
    """Return the means of quarters of an hour, of minutes in a short time, or else what was sampled."""
    days = shown.span.days
    is_short = days is not None and days <= MINUTES_UP_TO_DAYS
    begin_ns = shown.from_ns if shown.begin_ns is None else shown.begin_ns
    if begin_ns is None:
        first = repository.condition_trend(name, limit=1).items
        begin_ns = first[0].time_ns if first else shown.now_ns
    for step in (AveragingStep.MINUTE if is_short else AveragingStep.QUARTER_HOUR, AveragingStep.AS_SAMPLED):
        course = repository.measured_course(
            name, step, from_ns=begin_ns, to_ns=shown.now_ns + 1, pieces=PIECES
        )
        if course:
            return course
    return ()


def _current(name: str, course: Sequence[Measurement], motor: Motor | None, shown: TimeRange) -> Chart | None:
    limits: tuple[Limit, ...] = ()
    if motor is not None:
        full_A = full_load_current_A(motor)
        limits = (Limit(full_A, f"full load {full_A:.3g} A", Tone.MUTED),)
    return _chart("current", f"Current of {name}", "current", "A", course, CURRENTS, shown, limits=limits)


def _voltage(name: str, course: Sequence[Measurement], motor: Motor | None, shown: TimeRange) -> Chart | None:
    kinds, rated_V = LINE_VOLTAGES, None if motor is None else motor.nameplate.rated_voltage_V
    if not _is_known(course, LINE_VOLTAGES):
        kinds, rated_V = PHASE_VOLTAGES, None
    bands: tuple[Band, ...] = ()
    if rated_V is not None:
        ends = [round(rated_V * (1.0 + sign * VOLTAGE_DEVIATION), 1) for sign in (-1.0, 1.0)]
        bands = (Band(ends[0], ends[1], f"rated ±{PERCENT * VOLTAGE_DEVIATION:g} % (NEMA MG-1)"),)
    return _chart("voltage", f"Voltage of {name}", "voltage", "V", course, kinds, shown, bands=bands)


def _power(name: str, course: Sequence[Measurement], shown: TimeRange) -> Chart | None:
    kinds = (MeteredQuantity.POWER, MeteredQuantity.REACTIVE_POWER)
    return _chart("power", f"Power of {name}", "power", "kW, kvar", course, kinds, shown, scale=1.0 / KILO)


def _load(repository: Repository, name: str, shown: TimeRange) -> Chart | None:
    seen = [
        one.observation
        for one in repository.latest_records(name, limit=MOST_RECORDS)
        if one.observation.load_level is not None and shown.has(one.observation.time_ns)
    ]
    if not seen:
        return None
    loads = [None if one.load_level is None else round(PERCENT * one.load_level, 1) for one in seen]
    return Chart(
        key="load",
        caption=f"Load of {name}",
        x_label="time",
        y_label="torque over rated",
        y_unit="%",
        x_kind=AxisKind.TIME,
        x=[in_seconds(one.time_ns) for one in seen],
        series=[Series("load", loads, "%", Tone.ACCENT, Kind.LINE)],
        limits=[Limit(PERCENT, "rated", Tone.MUTED)],
        y_from=0.0,
        summary=f"Latest {loads[-1]} %, of {len(seen)} record{'s' if len(seen) > 1 else ''}.",
        x_from=shown.x_from,
        x_to=shown.x_to,
        sync=SYNC,
        height=HEIGHT,
    )


def _chart(
    key: str,
    caption: str,
    label: str,
    unit: str,
    course: Sequence[Measurement],
    kinds: Sequence[MeteredQuantity],
    shown: TimeRange,
    *,
    limits: Sequence[Limit] = (),
    bands: Sequence[Band] = (),
    scale: float = 1.0,
) -> Chart | None:
    if not _is_known(course, kinds):
        return None
    told = [one for one in kinds if _is_known(course, [one])]
    tones = PHASES if len(kinds) == len(PHASES) else (Tone.INK, Tone.ACCENT)
    series = [
        Series(_label(one), [_scaled(each, one, scale) for each in course], unit, tone, Kind.LINE)
        for one, tone in zip(told, tones, strict=False)
    ]
    latest = ", ".join(f"{one.label} {one.values[-1]}" for one in series if one.values[-1] is not None)
    return Chart(
        key=key,
        caption=caption,
        x_label="time",
        y_label=label,
        y_unit=unit,
        x_kind=AxisKind.TIME,
        x=[in_seconds(one.time_ns) for one in course],
        series=series,
        limits=limits,
        bands=bands,
        summary=f"Latest {latest} {unit}." if latest else "",
        x_from=shown.x_from,
        x_to=shown.x_to,
        sync=SYNC,
        height=HEIGHT,
    )


def _is_known(course: Sequence[Measurement], kinds: Sequence[MeteredQuantity]) -> bool:
    return any(one.values.get(kind.value) is not None for one in course for kind in kinds)


def _label(kind: MeteredQuantity) -> str:
    """Return "a" for a current of phase a, "ab" for a voltage between two."""
    if kind is MeteredQuantity.POWER:
        return "active"
    if kind is MeteredQuantity.REACTIVE_POWER:
        return "reactive"
    return kind.value.partition("_")[0][1:]


def _scaled(one: Measurement, kind: MeteredQuantity, scale: float) -> float | None:
    value = one.values.get(kind.value)
    return None if value is None else float(f"{scale * value:.{DIGITS}g}")
