"""The motors in figures, for Prometheus: a few time series a motor."""

import time
from collections import Counter
from collections.abc import Collection, Iterator, Mapping

from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from core.condition.kinds import State
from core.units import NANOSECONDS_PER_SECOND
from service.condition.staleness import is_stale, stale_after_ns
from service.storage.records import ConditionEntry
from service.storage.repository import Repository

QUANTILES = ("0.05", "0.5", "0.95")


def _of_a_motor(name: str, meaning: str, *labels: str) -> GaugeMetricFamily:
    return GaugeMetricFamily(f"mcc_motor_{name}", meaning, labels=["motor", *labels])


class MotorMetrics(Collector):
    """Asks the database when it is asked. stale_after_days: that of the settings."""

    def __init__(self, repository: Repository, stale_after_days: float | None) -> None:
        self._repository = repository
        self._stale_after_days = stale_after_days

    def collect(self) -> Iterator[Metric]:
        conditions = self._repository.conditions()
        yield from self._conditions(conditions.values())
        yield from self._levels(conditions.values())
        yield from self._latest_recordings()
        yield from self._backlog()

    def _conditions(self, conditions: Collection[ConditionEntry]) -> Iterator[Metric]:
        number = GaugeMetricFamily(
            "mcc_motors", "Number of motors by the state they are in", labels=["state"]
        )
        state = _of_a_motor("state", "1 for the state that the motor is in, 0 for the others", "state")
        kind = _of_a_motor("kind", "1 for the kind of what has changed or stands out in the motor", "kind")
        as_of = _of_a_motor(
            "condition_timestamp_seconds", "Time of the latest record in the motor's condition (UNIX time)"
        )
        age = _of_a_motor("condition_age_seconds", "Age of the latest record in the motor's condition")
        stale = _of_a_motor(
            "condition_stale",
            "1 where the latest record in the motor's condition is older than the motor's rule says, else 0",
        )
        now_ns, schedules = time.time_ns(), self._repository.schedules()
        states: Counter[State] = Counter()
        for found in conditions:
            motor = found.motor
            states[found.state] += 1
            for one in State:
                state.add_metric([motor, one], found.state is one)
            kind.add_metric([motor, found.kind], 1)
            oldest_ns = stale_after_ns(schedules.get(motor), self._stale_after_days)
            stale.add_metric([motor], is_stale(found, now_ns, oldest_ns))
            if found.as_of_ns is not None:
                as_of.add_metric([motor], found.as_of_ns / NANOSECONDS_PER_SECOND)
                age.add_metric([motor], (now_ns - found.as_of_ns) / NANOSECONDS_PER_SECOND)
        for one in State:
            number.add_metric([one], states[one])
        yield from (number, state, kind, as_of, age, stale)

    def _levels(self, conditions: Collection[ConditionEntry]) -> Iterator[Metric]:
        level = _of_a_motor("fault_level_ratio", "Fault level in all, over the turns of a phase")
        bound = _of_a_motor(
            "fault_level_bound_ratio", "Bounds of the 95 % interval of the fault level in all", "bound"
        )
        change = _of_a_motor("fault_level_change_ratio", "Change of the fault level since the reference")
        detectable = _of_a_motor(
            "fault_level_detectable_change_ratio", "Detection limit of a change since the reference"
        )
        growth = _of_a_motor(
            "fault_level_growth_ratio_per_day", "Growth of the fault level per day, where it has a trend"
        )
        forecast = _of_a_motor(
            "forecast_days",
            "Days from the latest record until the fault level reaches the limit, by their quantile",
            "quantile",
        )
        for found in conditions:
            motor = found.motor
            document = found.document or {}
            for family, value in (
                (level, found.mu_f),
                (change, found.change),
                (detectable, _number(document, "reference", "detectable")),
                (growth, _number(document, "growth_per_day")),
            ):
                if value is not None:
                    family.add_metric([motor], value)
            for side, value in zip(("low", "high"), found.mu_f_ci95 or (), strict=False):
                bound.add_metric([motor, side], value)
            for quantile, days in zip(QUANTILES, _forecast_days(found), strict=False):
                forecast.add_metric([motor, quantile], days)
        yield from (level, bound, change, detectable, growth, forecast)

    def _latest_recordings(self) -> Iterator[Metric]:
        limit = _of_a_motor(
            "detection_limit_ratio",
            "Fault level that nine of ten recordings such as the latest valid one show",
        )
        load = _of_a_motor("load_ratio", "Load in the latest valid recording, over the rated torque")
        recorded = _of_a_motor(
            "recording_timestamp_seconds", "Time of the latest recording that has a fault level (UNIX time)"
        )
        for found in self._repository.latest_figures():
            recorded.add_metric([found.motor], found.recorded_ns / NANOSECONDS_PER_SECOND)
            if found.detection_limit is not None:
                limit.add_metric([found.motor], found.detection_limit)
            if found.load_level is not None:
                load.add_metric([found.motor], found.load_level)
        yield from (limit, load, recorded)

    def _backlog(self) -> Iterator[Metric]:
        backlog = self._repository.backlog()
        yield GaugeMetricFamily(
            "mcc_motors_to_fold",
            "Motors whose condition is about to follow a change",
            value=backlog.motors_to_fold,
        )
        yield GaugeMetricFamily(
            "mcc_motors_set_aside",
            "Motors whose condition does not follow their records, because folding them failed",
            value=backlog.motors_set_aside,
        )


def _number(document: Mapping[str, object], *path: str) -> float | None:
    """Return a number of a condition's document; None where it has none."""
    found: object = document
    for key in path:
        found = found.get(key) if isinstance(found, Mapping) else None
    return found if isinstance(found, int | float) else None


def _forecast_days(entry: ConditionEntry) -> tuple[float, ...]:
    forecast = (entry.document or {}).get("forecast")
    days = forecast.get("days") if isinstance(forecast, dict) else None
    return tuple(days or ())
