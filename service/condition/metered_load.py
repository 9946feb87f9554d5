"""How a motor was loaded, by what its relay meters: its load profile, hours beyond limits, and its heat."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from core.load.course import LoadPoint, held_ns
from core.load.limits import DatedValue, HoursBeyond, hours_beyond
from core.load.metered import Metered, load_point
from core.load.profile import LoadProfile, load_profile
from core.machines.parameters import Motor, ThermalElement
from core.supply.definitions import nema_unbalance, unbalance_of_magnitudes
from core.thermal.bounded_rises import BoundedRises, bounded_capacity, bounded_rises
from core.thermal.course import CurrentStep
from core.thermal.full_load import full_load_current_A
from core.thermal.relay_model import settings_of
from core.thermal.two_bodies import TwoBodies
from core.thermal.winding_temperature import WindingTemperature, winding_temperature
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.condition.record_limits import RecordLimit, record_limits
from service.condition.relay_statistics import ComparedStatistics, compared_statistics
from service.plant import AveragingStep
from service.storage import Repository

MINUTES_UP_TO_DAYS: Final = 2
"""A longer time is told by means of quarters of an hour, a shorter one by those of minutes."""
LIVE: Final = 0.1
"""Share of the rated voltage, or frequency, below which a supply is switched off, and not low."""
MOST_RECORDS: Final = 240
REMEMBERED_NS: Final = NANOSECONDS_PER_DAY // 2
"""A motor forgets its heat within hours."""
USUAL_BODIES: Final = TwoBodies()

Known = tuple[Metered, LoadPoint]


@dataclass(frozen=True, slots=True)
class Limit:
    """A limit. name: what lies beyond it. value_of: the quantity that it is of, over its rated value."""

    name: str
    limit: float
    below: bool
    value_of: Callable[[Known, Motor], float | None]


@dataclass(frozen=True, slots=True)
class LimitHours:
    """How long a motor or its supply was beyond a limit."""

    name: str
    limit: float
    below: bool
    found: HoursBeyond


@dataclass(frozen=True, slots=True)
class WindingRise:
    """What the latest record tells of the winding's temperature, beside that of reference_ns."""

    time_ns: int
    reference_ns: int
    found: WindingTemperature


@dataclass(frozen=True, slots=True)
class MotorLoad:
    """How a motor was loaded.

    step: of the means that it is told by.  rises: of winding and frame at the end; None where nothing was
    metered.  winding: None without two records of the same sensors.  capacity_used: of the relay's thermal
    element, between bounds; None where the motors file does not tell its settings, or nothing was metered.
    relay: the relay's own statistics; None where none were brought.  of_records: how many records of that
    time lie beyond the limits of what no relay meters.
    """

    profile: LoadProfile
    step: AveragingStep
    limits: Sequence[LimitHours]
    rises: BoundedRises | None
    winding: WindingRise | None
    capacity_used: tuple[float, float] | None = None
    relay: ComparedStatistics | None = None
    of_records: Sequence[RecordLimit] = ()


def motor_load(
    repository: Repository, motor: Motor, *, days: int, now_ns: int, thermal: ThermalElement | None = None
) -> MotorLoad:
    """Return how a motor was loaded in the last days. Raises NotFoundError.

    thermal: its relay's thermal element, as the motors file tells it.
    """
    step = AveragingStep.MINUTE if days <= MINUTES_UP_TO_DAYS else AveragingStep.QUARTER_HOUR
    from_ns = now_ns - days * NANOSECONDS_PER_DAY
    metered = repository.metered(motor.name, step, from_ns=from_ns, to_ns=now_ns)
    known = [(one, load_point(one, motor)) for one in metered]
    longest_ns = step.value * NANOSECONDS_PER_SECOND
    return MotorLoad(
        profile=load_profile(
            [point for _, point in known], from_ns=from_ns, to_ns=now_ns, longest_ns=longest_ns
        ),
        step=step,
        limits=[_beyond(one, known, motor, longest_ns, now_ns) for one in LIMITS],
        rises=_rises(repository, motor, now_ns),
        winding=_winding(repository, motor),
        capacity_used=None if thermal is None else _capacity_used(repository, motor, thermal, now_ns),
        relay=compared_statistics(repository, motor),
        of_records=record_limits(repository, motor.name, from_ns=from_ns, to_ns=now_ns),
    )


def metered_duty(repository: Repository, motor: Motor, *, days: int, now_ns: int) -> float | None:
    """Return the share of the known hours of the last days that a motor ran; None where none is known."""
    step, from_ns = AveragingStep.QUARTER_HOUR, now_ns - days * NANOSECONDS_PER_DAY
    metered = repository.metered(motor.name, step, from_ns=from_ns, to_ns=now_ns)
    points = [load_point(one, motor) for one in metered]
    longest_ns = step.value * NANOSECONDS_PER_SECOND
    return load_profile(points, from_ns=from_ns, to_ns=now_ns, longest_ns=longest_ns).duty


def _load(known: Known, _motor: Motor) -> float | None:
    return known[1].load_level


def _voltage(known: Known, motor: Motor) -> float | None:
    lines_V = known[0].line_voltages_V
    if lines_V is None:
        return None
    share = sum(lines_V) / len(lines_V) / motor.nameplate.rated_voltage_V
    return share if share > LIVE else None


def _unbalance(known: Known, motor: Motor) -> float | None:
    lines_V = known[0].line_voltages_V
    return None if lines_V is None or _voltage(known, motor) is None else nema_unbalance(lines_V)


def _frequency(known: Known, motor: Motor) -> float | None:
    """Return the frequency where there is a supply: relays tell the last or the rated one without any."""
    metered = known[0]
    if metered.frequency_hz is None or _voltage(known, motor) is None:
        return None
    share = metered.frequency_hz / motor.nameplate.rated_frequency_Hz
    return share if share > LIVE else None


def _current_unbalance(known: Known, _motor: Motor) -> float | None:
    amps = known[0].currents_A
    return unbalance_of_magnitudes(amps) if amps is not None and known[1].runs else None


LIMITS: Final = (
    Limit("load above rated", 1.0, below=False, value_of=_load),
    Limit("load above 1.15 of rated", 1.15, below=False, value_of=_load),
    Limit("voltage below 90 %", 0.9, below=True, value_of=_voltage),
    Limit("voltage above 110 %", 1.1, below=False, value_of=_voltage),
    Limit("unbalance above 1 %", 0.01, below=False, value_of=_unbalance),
    Limit("unbalance above 5 %", 0.05, below=False, value_of=_unbalance),
    Limit("current unbalance above 10 %", 0.1, below=False, value_of=_current_unbalance),
    Limit("frequency below 98 %", 0.98, below=True, value_of=_frequency),
    Limit("frequency above 102 %", 1.02, below=False, value_of=_frequency),
    Limit("frequency below 95 %", 0.95, below=True, value_of=_frequency),
    Limit("frequency above 103 %", 1.03, below=False, value_of=_frequency),
)
"""NEMA MG-1: 12.44 for the voltage, 14.36 for its unbalance; 1.15 is the usual service factor.

NEMA MG-1, 14.36, says that currents are 6 to 10 times as uneven as voltages: of 10 %, a supply within 1 % is
not the whole cause. The frequency's limits are those of zones A and B of IEC 60034-1, 7.3.
"""


def _beyond(limit: Limit, known: Sequence[Known], motor: Motor, longest_ns: int, until_ns: int) -> LimitHours:
    values = [DatedValue(one[1].time_ns, limit.value_of(one, motor)) for one in known]
    found = hours_beyond(values, limit.limit, until_ns=until_ns, longest_ns=longest_ns, below=limit.below)
    return LimitHours(limit.name, limit.limit, limit.below, found)


def _rises(repository: Repository, motor: Motor, now_ns: int) -> BoundedRises | None:
    """Return the rises now, by means of minutes; what was before half a day changes them no more."""
    step = AveragingStep.MINUTE
    metered = repository.metered(motor.name, step, from_ns=now_ns - REMEMBERED_NS, to_ns=now_ns)
    if not metered:
        return None
    longest_ns = step.value * NANOSECONDS_PER_SECOND
    full_A = full_load_current_A(motor)
    return bounded_rises(_currents(metered, motor, full_A, longest_ns, now_ns), USUAL_BODIES)


def _capacity_used(
    repository: Repository, motor: Motor, thermal: ThermalElement, now_ns: int
) -> tuple[float, float] | None:
    """Return the capacity that the relay's element has used now, by means of minutes.

    A start of some seconds is not in these as it was: the element's rotor has cooled down an hour later.
    """
    step = AveragingStep.MINUTE
    metered = repository.metered(motor.name, step, from_ns=now_ns - REMEMBERED_NS, to_ns=now_ns)
    if not metered:
        return None
    longest_ns = step.value * NANOSECONDS_PER_SECOND
    full_A = thermal.full_load_current_A or full_load_current_A(motor)
    return bounded_capacity(_currents(metered, motor, full_A, longest_ns, now_ns), settings_of(thermal))


def _currents(
    metered: Sequence[Metered], motor: Motor, full_A: float, longest_ns: int, until_ns: int
) -> Iterator[CurrentStep | float]:
    """Yield the currents over full load, and between them the time of which nothing is known."""
    times = [one.time_ns for one in metered]
    holds = held_ns(times, longest_ns=longest_ns, until_ns=until_ns)
    for one, end_ns, held in zip(metered, (*times[1:], until_ns), holds, strict=True):
        held_s = held / NANOSECONDS_PER_SECOND
        if one.currents_A is None:
            yield held_s
        else:
            mean_A = sum(one.currents_A) / len(one.currents_A)
            yield CurrentStep(held_s, 0.0 if load_point(one, motor).stands else mean_A / full_A)
        gap = end_ns - one.time_ns - held
        if gap > 0:
            yield gap / NANOSECONDS_PER_SECOND


def _winding(repository: Repository, motor: Motor) -> WindingRise | None:
    """Compare the latest record's winding with that of the nearest load among the older half of the records.

    Between records at different loads the errors of the parameters do not cancel.
    """
    seen = [one.observation for one in repository.latest_records(motor.name, limit=MOST_RECORDS)]
    if not seen:
        return None
    latest = seen[-1]
    older = [one for one in seen[: len(seen) // 2] if one.recorder == latest.recorder]
    if not older:
        return None
    level = latest.load_level or 0.0
    nearest = min(older, key=lambda one: abs((one.load_level or 0.0) - level))
    return WindingRise(latest.time_ns, nearest.time_ns, winding_temperature(latest, nearest, motor))
