"""The parameters of a motor on its page: what its records tell of them, and over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.tracking.advice import NOTHING_TO_DO, drift_advice, drift_reason
from core.tracking.finding import ParameterName, TrackedParameter, TrackedParameters, TrackingState
from service.condition.tracking import COLUMNS
from service.storage import Repository
from service.storage.records import TrackedPoint
from service.web.charts import Chart, Kind, Series, Tone
from service.web.charts.chart import AxisKind
from service.web.motor.time_range import TimeRange, in_seconds
from service.web.motor.trend import HEIGHT, SYNC

MOST_RECORDS: Final = 400
"""The latest records that the charts show."""
DIGITS: Final = 2
TONES: Final = {TrackingState.DRIFTING: Tone.WATCH, TrackingState.STEADY: Tone.ACCENT}
STATES: Final = {
    TrackingState.DRIFTING: "watch",
    TrackingState.STEADY: "healthy",
    TrackingState.UNDETERMINED: "unknown",
}
"""The states of motors whose colours are shown."""


@dataclass(frozen=True, slots=True)
class ParametersSection:
    """What the page says of the parameters. found: None before any record was followed; no charts then."""

    found: TrackedParameters | None
    state: str
    sentence: str
    advice: str
    charts: Sequence[Chart]


def parameters_section(repository: Repository, motor: str, shown: TimeRange) -> ParametersSection:
    """Read what the page says of a motor's parameters. Raises NotFoundError."""
    found = repository.tracked_parameters(motor)
    if found is None:
        return ParametersSection(None, "unknown", "No record tells of the parameters yet.", NOTHING_TO_DO, ())
    points = repository.latest_tracked_points(motor, limit=MOST_RECORDS)
    known = [one for one in points if one.stator_resistance_change is not None and shown.has(one.time_ns)]
    drifting = found.state is TrackingState.DRIFTING
    return ParametersSection(
        found=found,
        state=STATES[found.state],
        sentence=_sentence(found),
        advice=drift_advice(found.causes) if drifting else NOTHING_TO_DO,
        charts=[_chart(motor, one, known, shown) for one in found.parameters] if known else (),
    )


def _sentence(found: TrackedParameters) -> str:
    if found.state is TrackingState.DRIFTING:
        return f"Parameters have drifted: {drift_reason(found)}."
    if found.state is TrackingState.UNDETERMINED:
        return "The records do not tell yet whether parameters have changed."
    steady = [one.name.words for one in found.parameters if one.state is TrackingState.STEADY]
    return f"As in the first records: {', '.join(steady)}."


def _chart(
    motor: str, parameter: TrackedParameter, points: Sequence[TrackedPoint], shown: TimeRange
) -> Chart:
    """Return the change of one parameter over time, with its interval and the reference."""
    column, words = COLUMNS[ParameterName(parameter.name)], parameter.name.words
    changes = [_percent(getattr(one, f"{column}_change")) for one in points]
    margins = [_percent(getattr(one, f"{column}_margin")) for one in points]
    ends = [(change - margin, change + margin) for change, margin in zip(changes, margins, strict=True)]
    return Chart(
        key=f"parameter-{column.replace('_', '-')}",
        caption=f"{words.capitalize()} of {motor}",
        x_label="time",
        y_label="change",
        y_unit="%",
        x_kind=AxisKind.TIME,
        x=[in_seconds(one.time_ns) for one in points],
        x_from=shown.x_from,
        x_to=shown.x_to,
        series=[
            Series(
                "change, 95 % interval",
                changes,
                "%",
                TONES.get(parameter.state, Tone.MUTED),
                Kind.LINE,
                [round(low, DIGITS) for low, _ in ends],
                [round(high, DIGITS) for _, high in ends],
            ),
            Series("first records", [0.0] * len(points), "%", Tone.MUTED, Kind.DASHES),
        ],
        summary=f"{parameter.state}: {'; '.join(parameter.reasons) or 'as in the first records'}.",
        sync=SYNC,
        height=HEIGHT,
    )


def _percent(fraction: float | None) -> float:
    return round(100.0 * (fraction or 0.0), DIGITS)
