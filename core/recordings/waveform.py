"""A recording: channels of samples in SI units, with the states beside them and the time of every sample."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from core.units import NANOSECONDS_PER_SECOND


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
class Digitals:
    """States recorded beside the samples: contacts, relay word bits.

    names: one a state, in the file's order.
    packed: uint8, shape (samples, ceil(len(names) / 8)); state k is bit k % 8 of column k // 8.
    """

    names: tuple[str, ...]
    packed: NDArray[np.uint8]

    def __post_init__(self) -> None:
        if self.packed.ndim != 2 or self.packed.shape[1] != -(-len(self.names) // 8):
            raise ValueError(f"{len(self.names)} states cannot be packed in shape {self.packed.shape}")

    @classmethod
    def of(cls, names: tuple[str, ...], states: NDArray[np.bool_]) -> "Digitals":
        """From states of shape (samples, len(names))."""
        return cls(names, np.packbits(states, axis=1, bitorder="little"))

    def unpacked(self) -> NDArray[np.bool_]:
        """All states, shape (samples, len(names))."""
        bits = np.unpackbits(self.packed, axis=1, count=len(self.names), bitorder="little")
        return bits.astype(np.bool_)

    def state(self, name: str) -> NDArray[np.bool_]:
        """One state, shape (samples,). Raises KeyError where none or several have this name."""
        if self.names.count(name) != 1:
            raise KeyError(name)
        k = self.names.index(name)
        return (self.packed[:, k // 8] >> (k % 8) & 1).astype(np.bool_)


@dataclass(frozen=True, slots=True)
class Recording:
    """Samples of one event, as the relay measured them.

    samples: float64, shape (channels, samples), each row in its channel's SI unit; NaN where missing.
    sample_rate_hz: the rate; where `instants_s` is given, the first of the rates, or the typical one.
    start_time_ns: UTC of the first sample, integer nanoseconds since 1970.
    trigger_index: sample at which the recorder was triggered, None if the file does not tell.
    nominal_frequency_hz: line frequency written in the file, None if it is not.
    digitals: the states recorded beside the samples, None if there are none.
    instants_s: time of every sample after the first, shape (samples,) [s], where they are not evenly spaced
        (several rates, a gap); None where they are.
    repairs: what a lenient reader mended, in words; empty for a file that was sound.
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
    digitals: Digitals | None = None
    instants_s: NDArray[np.float64] | None = None
    repairs: tuple[str, ...] = ()
    source: str = field(default="recording", compare=False)

    def __post_init__(self) -> None:
        if self.samples.ndim != 2 or self.samples.shape[0] != len(self.channels):
            raise ValueError(
                f"samples must have one row a channel: {len(self.channels)} channels, "
                f"array of shape {self.samples.shape}"
            )

        count = self.samples.shape[1]
        if self.digitals is not None and self.digitals.packed.shape[0] != count:
            raise ValueError(f"{self.digitals.packed.shape[0]} states beside {count} samples")
        if self.instants_s is not None and self.instants_s.shape != (count,):
            raise ValueError(f"{count} samples need as many instants, not shape {self.instants_s.shape}")

    @property
    def time_s(self) -> NDArray[np.float64]:
        """Time of every sample after the first, shape (samples,) [s]."""
        if self.instants_s is not None:
            return self.instants_s
        return np.arange(self.samples.shape[1]) / self.sample_rate_hz

    @property
    def duration_s(self) -> float:
        """Time spanned by the samples, the last one's period included [s]."""
        if self.instants_s is None or self.instants_s.size == 0:
            return float(self.samples.shape[1] / self.sample_rate_hz)
        return float(self.instants_s[-1]) + _last_step(self.instants_s, self.sample_rate_hz)

    @property
    def trigger_time_ns(self) -> int:
        """UTC of the trigger; of the first sample where the file names no trigger [ns]."""
        index = self.trigger_index or 0
        if self.instants_s is not None:
            return self.start_time_ns + round(float(self.instants_s[index]) * NANOSECONDS_PER_SECOND)
        return self.start_time_ns + round(index / self.sample_rate_hz * NANOSECONDS_PER_SECOND)


def _last_step(instants_s: NDArray[np.float64], sample_rate_hz: float) -> float:
    return float(instants_s[-1] - instants_s[-2]) if instants_s.size > 1 else 1 / sample_rate_hz
