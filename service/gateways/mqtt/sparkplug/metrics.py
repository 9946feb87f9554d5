"""A motor as a device of Sparkplug: the metrics it has, the same in each birth."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from core.units import NANOSECONDS_PER_MILLISECOND
from service.gateways.mqtt.sparkplug.payload import DataType, Metric, Quality, Value
from service.gateways.plant_state import figures
from service.gateways.plant_state.figures import MotorFigures, PlantState, RelayFigures

QUALITIES = {
    figures.Quality.GOOD: Quality.GOOD,
    figures.Quality.UNCERTAIN: Quality.STALE,
    figures.Quality.BAD: Quality.BAD,
}


def of_motor(motor: MotorFigures, state: PlantState) -> tuple[Metric, ...]:
    """Return the metrics of a motor.

    The time of what its condition says is that of the latest record in it; what is known beside records has
    the time at which it changed or was read.
    """
    read = _Told(state.read_ns, figures.Quality.GOOD if state.is_current else figures.Quality.UNCERTAIN)
    of_records = _Told(state.read_ns if motor.as_of_ns is None else motor.as_of_ns, motor.quality)
    running = _Told(state.read_ns if motor.running_ns is None else motor.running_ns, motor.running_quality)
    return (
        *read.metrics(_properties(motor)),
        *of_records.metrics(_condition(motor)),
        *running.metrics([("Running", DataType.STRING, motor.running)]),
        *read.metrics(_beside_records(motor)),
        _link(state.relays.get(motor.relay), read),
    )


@dataclass(frozen=True, slots=True)
class _Told:
    """When some values were known, and how far they can be relied on."""

    time_ns: int
    quality: figures.Quality

    def metrics(self, values: Iterable[tuple[str, DataType, Value]]) -> Iterator[Metric]:
        time_ms = _ms(self.time_ns) or 0
        for name, kind, value in values:
            yield Metric(name, kind, _known(value), time_ms, QUALITIES[self.quality])


def _properties(motor: MotorFigures) -> Iterator[tuple[str, DataType, Value]]:
    yield "Properties/Description", DataType.STRING, motor.description
    yield "Properties/Site", DataType.STRING, motor.site
    yield "Properties/Relay", DataType.STRING, motor.relay


def _condition(motor: MotorFigures) -> Iterator[tuple[str, DataType, Value]]:
    low, high = motor.mu_f_ci95 or (None, None)
    change_low, change_high = motor.change_ci95 or (None, None)
    yield "Condition/State", DataType.STRING, motor.state
    yield "Condition/Kind", DataType.STRING, motor.kind
    yield "Condition/Phase", DataType.STRING, motor.phase
    yield "Condition/Likely Phases", DataType.STRING, motor.likely_phases or None
    yield "Condition/Level", DataType.DOUBLE, motor.mu_f
    yield "Condition/Level Low", DataType.DOUBLE, low
    yield "Condition/Level High", DataType.DOUBLE, high
    yield "Condition/Change", DataType.DOUBLE, motor.change
    yield "Condition/Change Low", DataType.DOUBLE, change_low
    yield "Condition/Change High", DataType.DOUBLE, change_high
    yield "Condition/Detection Limit", DataType.DOUBLE, motor.detection_limit
    yield "Condition/Load", DataType.DOUBLE, motor.load_level
    yield "Condition/Rotor", DataType.STRING, motor.rotor
    yield "Condition/Finding", DataType.STRING, motor.finding
    yield "Condition/Since", DataType.DATE_TIME, _ms(motor.since_ns)
    yield "Condition/As Of", DataType.DATE_TIME, _ms(motor.as_of_ns)
    yield "Condition/Advice", DataType.STRING, motor.advice
    yield "Condition/Quality Reason", DataType.STRING, motor.quality_reason


def _beside_records(motor: MotorFigures) -> Iterator[tuple[str, DataType, Value]]:
    yield "Condition/Stale", DataType.BOOLEAN, motor.stale
    yield "Device Health", DataType.STRING, motor.device_health
    yield "Alarms/Open", DataType.INT32, motor.alarms
    yield "Alarms/Priority", DataType.STRING, motor.priority


def _link(relay: RelayFigures | None, read: _Told) -> Metric:
    if relay is None:
        told, link = read, None
    else:
        told = _Told(read.time_ns if relay.changed_ns is None else relay.changed_ns, relay.quality)
        link = relay.link
    (metric,) = told.metrics([("Relay/Link", DataType.STRING, link)])
    return metric


def changed(before: Sequence[Metric], now: Sequence[Metric]) -> list[Metric]:
    """Return the metrics of which another value or quality is told."""
    earlier = {metric.name: (metric.value, metric.quality) for metric in before}
    return [metric for metric in now if earlier.get(metric.name) != (metric.value, metric.quality)]


def _ms(time_ns: int | None) -> int | None:
    return None if time_ns is None else max(time_ns, 0) // NANOSECONDS_PER_MILLISECOND


def _known(value: Value) -> Value:
    return None if isinstance(value, float) and not math.isfinite(value) else value
