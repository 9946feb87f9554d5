"""A recording that was read to be looked at, and what each of its channels is."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.machines.motor_tables import layout_of
from core.machines.parameters import Motor
from core.recordings import Channel, Recording, read
from core.signals.terminals import LINES, PHASES, Terminals, terminals
from service.condition.healthy_records import MOST_VALUES


class Group(StrEnum):
    """Channels that are drawn together."""

    VOLTAGES = "voltages"
    CURRENTS = "currents"
    OTHERS = "others"


@dataclass(frozen=True, slots=True)
class ShownChannel:
    """A channel as it is drawn. factor: from samples to primary values, where the motor has a ratio."""

    row: int
    name: str
    group: Group
    phase: str | None
    unit: str
    factor: float = 1.0


@dataclass(frozen=True, slots=True)
class Opened:
    """A recording in memory. motor: None where the plant has it no more."""

    recording: Recording
    motor: Motor | None
    channels: tuple[ShownChannel, ...]

    @property
    def samples(self) -> int:
        """Return how many samples each channel has."""
        return int(self.recording.samples.shape[1])

    @property
    def trigger_s(self) -> float:
        """Return the time of the trigger after the first sample, 0 where the file names none [s]."""
        index = self.recording.trigger_index or 0
        instants = self.recording.instants_s
        return float(instants[index]) if instants is not None else index / self.recording.sample_rate_hz

    def values(self, channel: ShownChannel, first: int, last: int) -> NDArray[np.float64]:
        """Return the samples [first, last) of a channel in its unit."""
        return self.recording.samples[channel.row, first:last] * channel.factor

    def terminals(self) -> Terminals:
        """Return the quantities at the motor's terminals over the whole recording. Raises RecordingError."""
        if self.motor is None:
            return terminals(self.recording)
        named, ratios = self.motor.channels, self.motor.transformers
        return terminals(
            self.recording,
            currents=named.currents,
            phase_voltages=named.phase_voltages,
            line_voltages=named.line_voltages,
            voltage_ratio=ratios.voltage_ratio,
            current_ratio=ratios.current_ratio,
            inside_delta=ratios.inside_delta,
        )


def opened(path: Path, motor: Motor | None) -> Opened:
    """Read a recording to be looked at. Raises RecordingError (RecordingTooLongError), OSError."""
    lenient = motor is not None and motor.reads_leniently
    recording = read(path, lenient=lenient, most_values=MOST_VALUES, layout=layout_of(motor))
    return Opened(recording, motor, shown_channels(recording.channels, motor))


def shown_channels(channels: Sequence[Channel], motor: Motor | None) -> tuple[ShownChannel, ...]:
    """Return how each channel is drawn: by the motor's own channel names first, else by unit and phase."""
    named = _phases_by_name(motor)
    return tuple(_shown(row, channel, motor, named) for row, channel in enumerate(channels))


def _phases_by_name(motor: Motor | None) -> dict[str, str]:
    if motor is None:
        return {}
    names = motor.channels
    voltages = zip(names.phase_voltages or (), PHASES, strict=False)
    lines = zip(names.line_voltages or (), LINES, strict=False)
    return {**dict(lines), **dict(voltages), **dict(zip(names.currents or (), PHASES, strict=False))}


def _shown(row: int, channel: Channel, motor: Motor | None, named: dict[str, str]) -> ShownChannel:
    group = {"A": Group.CURRENTS, "V": Group.VOLTAGES}.get(channel.unit, Group.OTHERS)
    ratio = None
    if motor is not None and group is not Group.OTHERS:
        ratios = motor.transformers
        ratio = ratios.current_ratio if group is Group.CURRENTS else ratios.voltage_ratio
    factor = 1.0 if ratio is None else ratio / channel.applied_ratio
    phase = named.get(channel.name, channel.phase)
    return ShownChannel(row, channel.name, group, phase, channel.unit, factor)
