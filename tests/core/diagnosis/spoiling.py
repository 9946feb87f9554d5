"""What goes wrong with a recording: each function spoils a good one the way the field does."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from core.recordings import Channel, Quantity, Recording

Array = NDArray[np.float64]
CURRENTS, VOLTAGES = [0, 1, 2], [3, 4, 5]
LINES = ("ab", "bc", "ca")


def edited(record: Recording, rows: list[int], factor: float | Array) -> Recording:
    """Rows multiplied by a factor, a course, or one factor a row."""
    samples = record.samples.copy()
    samples[rows] *= factor
    return replace(record, samples=samples)


def exchanged(record: Recording, rows: list[int], by: list[int]) -> Recording:
    """Rows that carry what belongs to others."""
    samples = record.samples.copy()
    samples[rows] = record.samples[by]
    return replace(record, samples=samples)


def clipped(record: Recording, row: int, level: float, *, stated: bool = False) -> Recording:
    """Crests cut off at a share of the channel's greatest value; `stated`: as its full scale."""
    samples, channels = record.samples.copy(), list(record.channels)
    limit = level * float(np.abs(samples[row]).max())
    samples[row] = np.clip(samples[row], -limit, limit)
    if stated:
        channels[row] = replace(channels[row], full_scale=limit)
    return replace(record, samples=samples, channels=tuple(channels))


def repeated(record: Recording, rows: list[int], times: int) -> Recording:
    """Every value written several times."""
    samples = record.samples.copy()
    n = samples.shape[1]
    samples[rows] = np.repeat(samples[rows][:, ::times], times, axis=1)[:, :n]
    return replace(record, samples=samples)


def frozen(
    record: Recording, rows: list[int], first: int, last: int, value: float | None = None
) -> Recording:
    """A stretch of one value: the last one before it, or another."""
    samples = record.samples.copy()
    for row in rows:
        samples[row, first:last] = samples[row, first] if value is None else value
    return replace(record, samples=samples)


def saturated(record: Recording, rows: list[int], overload: float, direct: float = 0.0) -> Recording:
    """Current transformers whose flux knee lies at 1 / `overload` of the flux that the current asks for.

    The burden's voltage R i drives the flux; at the knee the core takes the whole current for itself, until
    the current turns round (the classical ideal core). `direct`: a direct current beside, of the crest.
    """
    samples = record.samples.copy()
    for row in rows:
        crest = float(np.abs(samples[row]).max())
        knee = crest * record.sample_rate_hz / (2 * np.pi * 50.0) / overload
        flux = 0.0
        for k, current in enumerate((samples[row] + direct * crest).tolist()):
            reached = min(max(flux + current, -knee), knee)
            samples[row, k], flux = reached - flux, reached
    return replace(record, samples=samples)


def pulsed(record: Recording, carrier_hz: float, link: float = 1.15) -> Recording:
    """Voltages as a two-level inverter makes them of the same sines, sampled without a filter."""
    samples = record.samples.copy()
    t = np.arange(samples.shape[1]) / record.sample_rate_hz
    triangle = 2.0 * np.abs(2.0 * ((carrier_hz * t + 0.13) % 1.0) - 1.0) - 1.0
    half = link * float(np.abs(samples[VOLTAGES]).max())
    samples[VOLTAGES] = half * np.where(samples[VOLTAGES] / half > triangle, 1.0, -1.0)
    return replace(record, samples=samples)


def with_line_voltages(record: Recording, kept: list[int]) -> Recording:
    """Line voltages in place of the phase voltages; two of them are enough."""
    volts = record.samples[VOLTAGES]
    lines = volts - np.roll(volts, -1, axis=0)
    channels = tuple(Channel(f"V{LINES[k].upper()}", Quantity.LINE_VOLTAGE, LINES[k], "V") for k in kept)
    return replace(
        record,
        samples=np.concatenate([record.samples[CURRENTS], lines[kept]]),
        channels=record.channels[:3] + channels,
    )
