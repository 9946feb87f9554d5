"""The conditions of motors in figures, for Prometheus: a few time series a motor."""

import time
from collections import Counter
from collections.abc import Iterator

from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from core.condition.kinds import State
from core.units import NANOSECONDS_PER_SECOND
from service.api.condition_documents import is_stale
from service.condition.staleness import stale_after_ns
from service.storage.records import ConditionEntry
from service.storage.repository import Repository

LABELS = ["motor"]


class ConditionMetrics(Collector):
    """Asks the database when it is asked. stale_after_days: that of the settings."""

    def __init__(self, repository: Repository, stale_after_days: float | None) -> None:
        self._repository = repository
        self._stale_after_days = stale_after_days

    def collect(self) -> Iterator[Metric]:
        number = GaugeMetricFamily(
            "mcc_motors", "Number of motors by the state they are in", labels=["state"]
        )
        state = GaugeMetricFamily(
            "mcc_motor_state",
            "1 for the state that the motor is in, 0 for the others",
            labels=["motor", "state"],
        )
        level = GaugeMetricFamily(
            "mcc_motor_fault_level_ratio", "Fault level in all, over the turns of a phase", labels=LABELS
        )
        change = GaugeMetricFamily(
            "mcc_motor_fault_level_change_ratio",
            "Change of the fault level since the reference",
            labels=LABELS,
        )
        kind = GaugeMetricFamily(
            "mcc_motor_kind",
            "1 for the kind of what has changed or stands out in the motor",
            labels=["motor", "kind"],
        )
        interval = GaugeMetricFamily(
            "mcc_motor_fault_level_bound_ratio",
            "Bounds of the 95 % interval of the fault level in all",
            labels=["motor", "bound"],
        )
        forecast = GaugeMetricFamily(
            "mcc_motor_forecast_days",
            "Days from the latest record until the fault level reaches the limit, by their quantile",
            labels=["motor", "quantile"],
        )
        as_of = GaugeMetricFamily(
            "mcc_motor_condition_timestamp_seconds",
            "Time of the latest record in the motor's condition (UNIX time)",
            labels=LABELS,
        )
        stale = GaugeMetricFamily(
            "mcc_motor_condition_stale",
            "1 where the latest record in the motor's condition is older than the motor's rule says, else 0",
            labels=LABELS,
        )
        now_ns, schedules = time.time_ns(), self._repository.schedules()
        states: Counter[State] = Counter()
        for motor, found in self._repository.conditions().items():
            states[found.state] += 1
            oldest_ns = stale_after_ns(schedules.get(motor), self._stale_after_days)
            stale.add_metric([motor], is_stale(found, now_ns, oldest_ns))
            for one in State:
                state.add_metric([motor, one], found.state is one)
            kind.add_metric([motor, found.kind], 1)
            for bound, value in zip(("low", "high"), found.mu_f_ci95 or (), strict=False):
                interval.add_metric([motor, bound], value)
            for quantile, days in zip(("0.05", "0.5", "0.95"), _forecast_days(found), strict=False):
                forecast.add_metric([motor, quantile], days)
            if found.mu_f is not None:
                level.add_metric([motor], found.mu_f)
            if found.change is not None:
                change.add_metric([motor], found.change)
            if found.as_of_ns is not None:
                as_of.add_metric([motor], found.as_of_ns / NANOSECONDS_PER_SECOND)
        for one in State:
            number.add_metric([one], states[one])
        yield from (number, state, kind, level, interval, change, forecast, as_of, stale)
        backlog = self._repository.backlog()
        yield GaugeMetricFamily(
            "mcc_recordings_to_observe",
            "Recordings from before there were conditions that are yet to be taken into account",
            value=backlog.unobserved_recordings,
        )
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


def _forecast_days(entry: ConditionEntry) -> tuple[float, ...]:
    forecast = (entry.document or {}).get("forecast")
    days = forecast.get("days") if isinstance(forecast, dict) else None
    return tuple(days or ())
