"""The supply of a motor on its page: as its latest record shows it, and over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.units import NANOSECONDS_PER_SECOND
from service.client.rotor_and_supply import supply_words
from service.storage import Repository
from service.storage.records import SupplyEntry
from service.web.charts import Chart, Kind, Series, Tone
from service.web.charts.chart import AxisKind

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


def supply_section(repository: Repository, motor: str) -> SupplySection:
    """Read what the page says of a motor's supply."""
    entries = repository.latest_supply(motor, limit=MOST_RECORDS)
    if not entries:
        return SupplySection(None, (), (), None)
    figures = entries[-1].figures
    return SupplySection(entries[-1], supply_words(figures), figures.reasons, _chart(motor, entries))


def _chart(motor: str, entries: Sequence[SupplyEntry]) -> Chart:
    of_each = [one.figures for one in entries]
    lines = (
        ("voltage beside the rated one", [one.voltage_deviation for one in of_each], Tone.INK),
        ("unbalance of the voltages (NEMA)", [one.voltage_unbalance_nema for one in of_each], Tone.ACCENT),
        ("distortion of the voltage", [one.thd_voltage for one in of_each], Tone.MODEL),
        ("unbalance of the currents", [one.current_unbalance for one in of_each], Tone.MUTED),
    )
    return Chart(
        key="supply",
        caption=f"Supply of {motor}",
        x_label="time",
        y_label="share",
        y_unit="%",
        x_kind=AxisKind.TIME,
        x=[round(one.time_ns / NANOSECONDS_PER_SECOND, 3) for one in entries],
        series=[
            Series(label, [_percent(value) for value in values], "%", tone, Kind.LINE)
            for label, values, tone in lines
        ],
        summary=f"{len(entries)} record{'s' if len(entries) > 1 else ''}.",
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else round(PERCENT * share, DIGITS)
