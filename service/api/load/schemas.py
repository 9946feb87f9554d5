"""Documents of how a motor was loaded. Fields that are null are not known (yet)."""

from pydantic import Field

from core.units import SECONDS_PER_HOUR
from service.api.document import Document, Listed
from service.api.times import Time
from service.condition.metered_load import MotorLoad

Interval = tuple[float, float]


class LoadClass(Document):
    """Hours and energy in a class of torque, over the rated one; the last class has no upper end."""

    from_level: float
    to_level: float | None
    hours: float
    energy_kWh: float


class LimitHours(Document):
    """How long something was beyond a limit. longest_hours: without a break. worst: value furthest beyond.

    known_hours: time of which the quantity is known.
    """

    name: str
    limit: float
    below: bool
    hours: float
    known_hours: float
    longest_hours: float
    worst: float | None


class RecordLimit(Document):
    """How many records of that time lay beyond a limit. records: that tell the quantity. worst: largest."""

    name: str
    limit: float
    records: int
    beyond: int
    share: float | None
    worst: float | None


class ThermalState(Document):
    """Rises above the ambient temperature, between bounds, of a usual motor with such currents.

    winding_rise_K, frame_rise_K: as if the motor had stood, and had run at rated current, where nothing is
    known. from_resistance_K: how much hotter the winding is than in the record of reference_time, by its
    resistance (..._ci95: 95 % interval); reasons: why that is not told. relay_capacity_used: of the relay's
    thermal element, over the value at which it trips, between the same bounds; null where the motors file has
    no [thermal].
    """

    winding_rise_K: Interval | None
    frame_rise_K: Interval | None
    from_resistance_K: float | None
    from_resistance_K_ci95: Interval | None
    record_time: Time | None
    reference_time: Time | None
    reasons: Listed[str]
    relay_capacity_used: Interval | None


class RelayStatistics(Document):
    """What the relay's latest statistics report tells, and what the service counted in the same time.

    counted_...: null where the report does not tell since when. known_hours: of that time, whether the motor
    ran. remarks: where both disagree, and the likely reason.
    """

    time: Time
    since_time: Time | None
    running_hours: float | None
    standing_hours: float | None
    starts: int | None
    mean_current_A: float | None
    peak_current_A: float | None
    peak_start_current_A: float | None
    longest_start_s: float | None
    trips: dict[str, int]
    counted_starts: int | None
    counted_running_hours: float | None
    known_hours: float | None
    remarks: Listed[str]


class LoadProfile(Document):
    """How a motor was loaded. All is null, or empty, before a service has read the motors file.

    step_s: of the means that it is told by. running_hours, standing_hours and unknown_hours make up the whole
    time. unclassed_hours: running, at a load that is not known. duty: running over known hours. starts: at
    least so many. record_limits: of what no relay meters; shares of records, not of hours.
    """

    from_time: Time | None = None
    to_time: Time | None = None
    step_s: int | None = None
    classes: Listed[LoadClass] = Field(default_factory=list)
    running_hours: float | None = None
    standing_hours: float | None = None
    unknown_hours: float | None = None
    unclassed_hours: float | None = None
    energy_kWh: float | None = None
    duty: float | None = None
    mean_load: float | None = None
    starts: int | None = None
    limits: Listed[LimitHours] = Field(default_factory=list)
    record_limits: Listed[RecordLimit] = Field(default_factory=list)
    thermal: ThermalState | None = None
    relay_statistics: RelayStatistics | None = None


def load_document(load: MotorLoad) -> LoadProfile:
    """Return the document of how a motor was loaded."""
    profile = load.profile.as_dict()
    return LoadProfile.model_validate(
        {
            **profile,
            "from_time": profile.pop("from_ns"),
            "to_time": profile.pop("to_ns"),
            "step_s": load.step.value,
            "limits": [
                {
                    "name": one.name,
                    "limit": one.limit,
                    "below": one.below,
                    "hours": one.found.hours,
                    "known_hours": one.found.known_hours,
                    "longest_hours": one.found.longest_hours,
                    "worst": one.found.worst,
                }
                for one in load.limits
            ],
            "record_limits": [
                {
                    "name": one.name,
                    "limit": one.limit,
                    "records": one.records,
                    "beyond": one.beyond,
                    "share": one.share,
                    "worst": one.worst,
                }
                for one in load.of_records
            ],
            "thermal": _thermal(load),
            "relay_statistics": _relay(load),
        }
    )


def _relay(load: MotorLoad) -> dict[str, object] | None:
    if load.relay is None:
        return None
    told, metered = load.relay.told, load.relay.metered
    return {
        "time": told.time_ns,
        "since_time": told.since_ns,
        "running_hours": _hours(told.running_s),
        "standing_hours": _hours(told.stopped_s),
        "starts": told.starts,
        "mean_current_A": told.mean_current_A,
        "peak_current_A": told.peak_current_A,
        "peak_start_current_A": told.peak_start_current_A,
        "longest_start_s": told.longest_start_s,
        "trips": dict(told.trips),
        "counted_starts": load.relay.counted_starts,
        "counted_running_hours": None if metered is None else metered.running_hours,
        "known_hours": None if metered is None else metered.known_hours,
        "remarks": load.relay.remarks,
    }


def _hours(seconds: float | None) -> float | None:
    return None if seconds is None else seconds / SECONDS_PER_HOUR


def _thermal(load: MotorLoad) -> dict[str, object]:
    rises, winding = load.rises, load.winding
    found = None if winding is None else winding.found
    return {
        "winding_rise_K": None if rises is None else (rises.low.winding_K, rises.high.winding_K),
        "frame_rise_K": None if rises is None else (rises.low.frame_K, rises.high.frame_K),
        "from_resistance_K": None if found is None else found.rise_K,
        "from_resistance_K_ci95": None if found is None else found.rise_K_ci95,
        "record_time": None if winding is None else winding.time_ns,
        "reference_time": None if winding is None else winding.reference_ns,
        "reasons": ("there are no two records of the same sensors",) if found is None else found.reasons,
        "relay_capacity_used": load.capacity_used,
    }
