"""The charts of a recording: voltages, currents, what the model leaves, states, spectrum."""

from collections.abc import Iterator, Sequence
from math import floor, isfinite, log10
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.signals.terminals import PHASES
from service.waveforms.modelled import RESIDUAL, modelled_window
from service.waveforms.opened import Group
from service.waveforms.replaying import Replayed
from service.waveforms.spectra import CurrentSpectrum
from service.waveforms.states import StateTimeline
from service.waveforms.windows import SampleWindow, WindowChannel
from service.web.charts import Chart, Kind, Mark, Series, Tone

SYNC: Final = "recording"
"""The waveforms share cursor and zoom under this name."""
INTERVALS: Final = 600
"""Of the first view; finer ones come with the zoom."""
SPECTRUM_POINTS: Final = 1200
MOST_ROWS: Final = 24
"""States in the chart; the list beneath has all."""
DIGITS: Final = 5
LOWEST_DB: Final = -100.0

TITLES: Final = {Group.VOLTAGES: "Voltages", Group.CURRENTS: "Currents", Group.OTHERS: "Other channels"}
QUANTITIES: Final = {Group.VOLTAGES: "voltage", Group.CURRENTS: "current", Group.OTHERS: "value"}


def waveform_charts(window: SampleWindow, trigger_s: float) -> tuple[Chart, ...]:
    """Return a chart of each group of channels that there is; one of each unit among the others."""
    charts = []
    for group in (Group.VOLTAGES, Group.CURRENTS):
        channels = [one for one in window.channels if one.group == group]
        if channels:
            charts.append(_chart(group, group.value, TITLES[group], channels, window, trigger_s))
    others = [one for one in window.channels if one.group == Group.OTHERS]
    for number, unit in enumerate(dict.fromkeys(one.unit for one in others)):
        channels = [one for one in others if one.unit == unit]
        title = f"{TITLES[Group.OTHERS]} ({unit})" if unit else TITLES[Group.OTHERS]
        charts.append(_chart(Group.OTHERS, f"others-{number}", title, channels, window, trigger_s))
    return tuple(charts)


def residual_chart(replayed: Replayed) -> Chart:
    """Return what the model leaves of the currents."""
    window = modelled_window(replayed, INTERVALS)
    left = [one for one in window.channels if one.name == RESIDUAL]
    return Chart(
        key="residual",
        caption="Residual: measured minus modelled current",
        summary="What the model of the motor does not explain.",
        x_label="time",
        x_unit="s",
        y_label="residual",
        y_unit="A",
        x=window.times_s.tolist(),
        series=[_series(one, f"residual {one.phase}") for one in left],
        sync=SYNC,
        height=180,
    )


def states_chart(states: Sequence[StateTimeline], duration_s: float) -> Chart | None:
    """Return the states that change, by their changes; None where none does."""
    moving = [one for one in states if one.changes_s][:MOST_ROWS]
    if not moving:
        return None
    times = sorted({0.0, duration_s, *(at for one in moving for at in one.changes_s)})
    return Chart(
        key="states",
        caption="States that change",
        summary=f"{len(moving)} of {len(states)} states change.",
        x_label="time",
        x_unit="s",
        y_label="state",
        x=times,
        series=[Series(one.name, [float(one.at(at)) for at in times], kind=Kind.STEPS) for one in moving],
        sync=SYNC,
        height=60 + 26 * len(moving),
        in_rows=True,
    )


def spectrum_chart(spectrum: CurrentSpectrum) -> Chart:
    """Return the spectrum of the line currents with the lines that matter marked."""
    levels = np.maximum(spectrum.level_dB, LOWEST_DB)
    return Chart(
        key="spectrum",
        caption="Spectrum of the currents",
        summary=f"Beside the strongest line. Lines nearer than {spectrum.resolution_hz:.3g} Hz run into one.",
        x_label="frequency",
        x_unit="Hz",
        y_label="level",
        y_unit="dB",
        x=spectrum.frequency_hz.round(4).tolist(),
        series=[
            Series(f"i{phase}", row.round(2).tolist(), "dB", tone=_tone(phase))
            for phase, row in zip(PHASES, levels, strict=True)
        ],
        marks=[Mark(one.line.frequency_hz, one.line.label) for one in spectrum.lines],
        y_from=LOWEST_DB,
        y_to=0.0,
    )


def _chart(
    group: Group,
    key: str,
    title: str,
    channels: Sequence[WindowChannel],
    window: SampleWindow,
    trigger_s: float,
) -> Chart:
    unit = channels[0].unit
    return Chart(
        key=key,
        caption=title,
        summary=_summary(channels, unit),
        x_label="time",
        x_unit="s",
        y_label=QUANTITIES[group],
        y_unit=unit,
        x=window.times_s.tolist(),
        series=[_series(one, one.name) for one in channels],
        marks=[Mark(trigger_s, "trigger")] if trigger_s > 0.0 else [],
        sync=SYNC,
        height=220,
    )


def _summary(channels: Sequence[WindowChannel], unit: str) -> str:
    """Return the largest magnitude of all channels in words."""
    largest = max(_largest(channels), default=None)
    return "No sample was measured." if largest is None else f"At most {largest:.4g} {unit}".rstrip() + "."


def _largest(channels: Sequence[WindowChannel]) -> Iterator[float]:
    for one in channels:
        extremes = np.concatenate([one.lowest, one.highest])
        known = extremes[np.isfinite(extremes)]
        if known.size:
            yield float(np.abs(known).max())


def _series(channel: WindowChannel, label: str) -> Series:
    decimals = _decimals(channel)
    low, high = _rounded(channel.lowest, decimals), _rounded(channel.highest, decimals)
    middle = _rounded((channel.lowest + channel.highest) / 2.0, decimals)
    if low == high:
        return Series(label, middle, channel.unit, tone=_tone(channel.phase))
    return Series(
        label, middle, channel.unit, tone=_tone(channel.phase), kind=Kind.ENVELOPE, low=low, high=high
    )


def _decimals(channel: WindowChannel) -> int:
    """Return how many decimals a channel's values need: finer than a screen shows, and no longer."""
    largest = max(_largest([channel]), default=0.0)
    return DIGITS - 1 - floor(log10(largest)) if largest > 0.0 else 0


def _rounded(values: NDArray[np.float64], decimals: int) -> list[float | None]:
    rounded = np.round(values, decimals).tolist()
    return [value if isfinite(value) else None for value in rounded]


def _tone(phase: str | None) -> Tone:
    letter = (phase or "")[:1]
    return Tone(letter) if letter in PHASES else Tone.MUTED
