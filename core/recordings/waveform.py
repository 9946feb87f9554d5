"""A recording: channels of samples at one rate, in SI units, with its start time."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray


class Quantity(StrEnum):
    """What a channel measures. Voltages are told apart by their reference, because Clarke needs to know."""

    CURRENT = "current"
    PHASE_VOLTAGE = "phase_voltage"
    LINE_VOLTAGE = "line_voltage"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class Channel:
    """One analogue channel.

    `phase` is "a", "b", "c", "n" for phase quantities, "ab", "bc", "ca" for line voltages, None if unknown.
    `unit` is the SI unit of the samples after scaling ("A", "V"; otherwise as written in the file).
    `full_scale` is the largest magnitude the recorder can represent [unit], None if the file does not tell.
    """

    name: str
    quantity: Quantity
    phase: str | None
    unit: str
    full_scale: float | None = None


@dataclass(frozen=True, slots=True)
class Recording:
    """Samples of one event, as the relay measured them.

    samples: float64, shape (channels, samples), each row in its channel's SI unit.
    sample_rate_hz: one rate for the whole recording.
    start_time_ns: UTC of the first sample, integer nanoseconds since 1970.
    trigger_index: sample at which the recorder was triggered, None if the file does not tell.
    nominal_frequency_hz: line frequency written in the file, None if it is not.
    source: the file it was read from, for messages; recordings that differ only here are the same.
    """

    samples: NDArray[np.float64]
    sample_rate_hz: float
    start_time_ns: int
    channels: tuple[Channel, ...]
    trigger_index: int | None = None
    nominal_frequency_hz: float | None = None
    station: str = ""
    device: str = ""
    source: str = field(default="recording", compare=False)

    def __post_init__(self) -> None:
        if self.samples.ndim != 2 or self.samples.shape[0] != len(self.channels):
            raise ValueError(
                f"samples must have one row a channel: {len(self.channels)} channels, "
                f"array of shape {self.samples.shape}"
            )

    @property
    def duration_s(self) -> float:
        """Time spanned by the samples [s]."""
        return float(self.samples.shape[1] / self.sample_rate_hz)

    @property
    def trigger_time_ns(self) -> int:
        """UTC of the trigger; of the first sample where the file names no trigger [ns]."""
        return self.start_time_ns + round((self.trigger_index or 0) / self.sample_rate_hz * 1e9)
