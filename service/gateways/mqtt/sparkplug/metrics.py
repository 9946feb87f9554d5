"""A motor as a device of Sparkplug: the metrics it has, the same in each birth."""

import math
from collections.abc import Sequence

from core.units import NANOSECONDS_PER_MILLISECOND
from service.gateways.mqtt.sparkplug.payload import DataType, Metric, Quality, Value
from service.gateways.plant_state import figures
from service.gateways.plant_state.figures import MotorFigures, PlantState

QUALITIES = {
    figures.Quality.GOOD: Quality.GOOD,
    figures.Quality.UNCERTAIN: Quality.STALE,
    figures.Quality.BAD: Quality.BAD,
}


def of_motor(motor: MotorFigures, state: PlantState) -> tuple[Metric, ...]:
    """Return the metrics of a motor. Their time is that of the latest record in its condition."""
    relay = state.relays.get(motor.relay)
    low, high = motor.mu_f_ci95 or (None, None)
    change_low, change_high = motor.change_ci95 or (None, None)
    told: Sequence[tuple[str, DataType, Value]] = (
        ("Properties/Description", DataType.STRING, motor.description),
        ("Properties/Site", DataType.STRING, motor.site),
        ("Properties/Relay", DataType.STRING, motor.relay),
        ("Condition/State", DataType.STRING, motor.state),
        ("Condition/Kind", DataType.STRING, motor.kind),
        ("Condition/Phase", DataType.STRING, motor.phase),
        ("Condition/Level", DataType.DOUBLE, motor.mu_f),
        ("Condition/Level Low", DataType.DOUBLE, low),
        ("Condition/Level High", DataType.DOUBLE, high),
        ("Condition/Change", DataType.DOUBLE, motor.change),
        ("Condition/Change Low", DataType.DOUBLE, change_low),
        ("Condition/Change High", DataType.DOUBLE, change_high),
        ("Condition/Detection Limit", DataType.DOUBLE, motor.detection_limit),
        ("Condition/Load", DataType.DOUBLE, motor.load_level),
        ("Condition/Rotor", DataType.STRING, motor.rotor),
        ("Condition/Stale", DataType.BOOLEAN, motor.stale),
        ("Condition/Since", DataType.DATE_TIME, _ms(motor.since_ns)),
        ("Condition/As Of", DataType.DATE_TIME, _ms(motor.as_of_ns)),
        ("Condition/Advice", DataType.STRING, motor.advice),
        ("Condition/Quality Reason", DataType.STRING, motor.quality_reason),
        ("Running", DataType.STRING, motor.running),
        ("Device Health", DataType.STRING, motor.device_health),
        ("Alarms/Open", DataType.INT32, motor.alarms),
        ("Alarms/Priority", DataType.STRING, motor.priority),
        ("Relay/Link", DataType.STRING, None if relay is None else relay.link),
    )
    time_ms = _ms(state.read_ns if motor.as_of_ns is None else motor.as_of_ns) or 0
    quality = QUALITIES[motor.quality]
    return tuple(Metric(name, kind, _known(value), time_ms, quality) for name, kind, value in told)


def changed(before: Sequence[Metric], now: Sequence[Metric]) -> list[Metric]:
    """Return the metrics of which another value or quality is told."""
    earlier = {metric.name: (metric.value, metric.quality) for metric in before}
    return [metric for metric in now if earlier.get(metric.name) != (metric.value, metric.quality)]


def _ms(time_ns: int | None) -> int | None:
    return None if time_ns is None else max(time_ns, 0) // NANOSECONDS_PER_MILLISECOND


def _known(value: Value) -> Value:
    return None if isinstance(value, float) and not math.isfinite(value) else value
