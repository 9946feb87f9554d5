"""The supply of a motor on its page: as its latest record shows it, and over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.motor_condition.supply import VOLTAGE_DEVIATION
from service.client.rotor_and_supply import supply_words
from service.storage import Repository
from service.storage.records import SupplyEntry
from service.web.charts import Band, Chart, Kind, Limit, Series, Tone
from service.web.charts.chart import AxisKind
from service.web.motor.time_range import TimeRange, in_seconds
from service.web.motor.trend import SYNC, TAB_HEIGHT

MOST_RECORDS: Final = 400
"""The latest records that the chart shows."""
PERCENT: Final = 100.0
DIGITS: Final = 3


@dataclass(frozen=True, slots=True)
class SupplySection:
    """What the page says of the supply. chart: None where no record shows it."""

    latest: SupplyEntry | None
    words: Sequence[str]
    reasons: Sequence[str]
    chart: Chart | None


def supply_section(repository: Repository, motor: str, shown: TimeRange) -> SupplySection:
    """Read what the page says of a motor's supply."""
    entries = repository.latest_supply(motor, limit=MOST_RECORDS)
    if not entries:
        return SupplySection(None, (), (), None)
    figures = entries[-1].figures
    return SupplySection(entries[-1], supply_words(figures), figures.reasons, _chart(motor, entries, shown))


def _chart(motor: str, every: Sequence[SupplyEntry], shown: TimeRange) -> Chart | None:
    entries = [one for one in every if shown.has(one.time_ns)]
    if not entries:
        return None
    of_each = [one.figures for one in entries]
    lines = (
        ("voltage beside the rated one", "voltage", [one.voltage_deviation for one in of_each], Tone.INK),
        (
            "unbalance of the voltages (NEMA)",
            "V unbalance",
            [one.voltage_unbalance_nema for one in of_each],
            Tone.ACCENT,
        ),
        ("distortion of the voltage", "THD", [one.thd_voltage for one in of_each], Tone.MODEL),
        ("unbalance of the currents", "I unbalance", [one.current_unbalance for one in of_each], Tone.MUTED),
    )
    allowed = PERCENT * VOLTAGE_DEVIATION
    return Chart(
        key="supply",
        caption=f"Supply of {motor}",
        x_label="time",
        y_label="share",
        y_unit="%",
        x_kind=AxisKind.TIME,
        x=[in_seconds(one.time_ns) for one in entries],
        series=[
            Series(label, [_percent(value) for value in values], "%", tone, Kind.LINE, short=short)
            for label, short, values, tone in lines
        ],
        bands=[Band(-allowed, allowed, "voltage allowed (NEMA MG-1)")],
        limits=[Limit(1.0, "unbalance: derate from here on", Tone.WATCH)],
        x_from=shown.x_from,
        x_to=shown.x_to,
        sync=SYNC,
        height=TAB_HEIGHT,
        summary=f"{len(entries)} record{'s' if len(entries) > 1 else ''}.",
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else round(PERCENT * share, DIGITS)
