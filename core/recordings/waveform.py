"""A recording: channels of samples in SI units, with the states beside them and the time of every sample."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import UnknownTimeError
from core.units import NANOSECONDS_PER_SECOND

REVERSED_LINES = {"ba": "ab", "cb": "bc", "ac": "ca"}
"""Line voltages named the other way round, and those of which they are the negative."""


class Quantity(StrEnum):
    """What a channel measures; voltages are told apart by their reference, which Clarke's axes depend on."""

    CURRENT = "current"
    PHASE_VOLTAGE = "phase_voltage"
    LINE_VOLTAGE = "line_voltage"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class Channel:
    """One analogue channel.

    Parameters
    ----------
    name : str
        Name as written in the file.
    quantity : Quantity
        What it measures.
    phase : str or None
        "a", "b", "c", "n" for phase quantities, "ab", "bc", "ca" for line voltages, "ba", "cb", "ac" for
        those recorded the other way round, None if unknown.
    unit : str
        SI unit of the samples after scaling ("A", "V"; otherwise as written in the file).
    full_scale : float or None, optional
        Largest magnitude the recorder can represent [unit], None if the file does not tell.
    transformer_ratio : float or None, optional
        Primary over secondary value of its instrument transformer, as the file tells it; None where it tells
        none, or a ratio of 1, which many a recorder writes for want of knowledge.
    applied_ratio : float, default 1.0
        Ratio by which the values as written were multiplied because the file says that they are secondary.
    is_constant : bool, default False
        Whether the file gives the channel one value whatever was sampled, as recorders do with spare inputs.
    unit_is_assumed : bool, default False
        Whether the file has no unit, and that of its quantity is taken for granted.
    """

    name: str
    quantity: Quantity
    phase: str | None
    unit: str
    full_scale: float | None = None
    transformer_ratio: float | None = None
    applied_ratio: float = 1.0
    is_constant: bool = False
    unit_is_assumed: bool = False


@dataclass(frozen=True, slots=True)
class Digitals:
    """States recorded beside the samples: contacts, relay word bits.

    Parameters
    ----------
    names : tuple of str
        Names of the states, in the file's order.
    packed : ndarray of uint8, shape (samples, ceil(len(names) / 8))
        State k is bit k % 8 of column k // 8.
    """

    names: tuple[str, ...]
    packed: NDArray[np.uint8]

    def __post_init__(self) -> None:
        if self.packed.ndim != 2 or self.packed.shape[1] != -(-len(self.names) // 8):
            raise ValueError(f"{len(self.names)} states cannot be packed in shape {self.packed.shape}")

    @classmethod
    def of(cls, names: tuple[str, ...], states: NDArray[np.bool_]) -> "Digitals":
        """Pack states.

        Parameters
        ----------
        names : tuple of str
            Names of the states.
        states : ndarray of bool, shape (samples, len(names))
            The states.

        Returns
        -------
        Digitals
            The packed states.
        """
        return cls(names, np.packbits(states, axis=1, bitorder="little"))

    def unpacked(self) -> NDArray[np.bool_]:
        """Return all states.

        Returns
        -------
        ndarray of bool, shape (samples, len(names))
            The states.
        """
        bits = np.unpackbits(self.packed, axis=1, count=len(self.names), bitorder="little")
        return bits.astype(np.bool_)

    def state(self, name: str) -> NDArray[np.bool_]:
        """Return one state.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        ndarray of bool, shape (samples,)
            The state at every sample.

        Raises
        ------
        KeyError
            If none or several have this name.
        """
        if self.names.count(name) != 1:
            raise KeyError(name)
        k = self.names.index(name)
        return (self.packed[:, k // 8] >> (k % 8) & 1).astype(np.bool_)


@dataclass(frozen=True, slots=True)
class Recording:
    """Samples of one event, as the relay measured them.

    Recordings that differ only in `source` and `has_time_code` are the same.

    Parameters
    ----------
    samples : ndarray, shape (channels, samples)
        Each row in its channel's SI unit; NaN where missing.
    sample_rate_hz : float
        Sampling rate [Hz]; where `instants_s` is given, the first of the rates, or the typical one.
    start_time_ns : int or None
        UTC of the first sample [ns since 1970]; None where a lenient reader found no time. Times of a file
        that does not tell how far they are ahead of UTC are taken as UTC.
    channels : tuple of Channel
        The channels, one a row.
    trigger_index : int or None, optional
        Sample at which the recorder was triggered, None if the file does not tell.
    nominal_frequency_hz : float or None, optional
        Line frequency written in the file [Hz], None if it is not.
    station : str, default ''
        Name of the station.
    device : str, default ''
        Name of the recorder.
    digitals : Digitals or None, optional
        States recorded beside the samples, None if there are none.
    instants_s : ndarray or None, shape (samples,), optional
        Time of every sample after the first [s], where they are not evenly spaced (several rates, a gap);
        None where they are.
    repairs : tuple of str, optional
        What a lenient reader mended, in words; empty for a file that was sound.
    warnings : tuple of str, optional
        What departs from the standard without a change of any value, in words.
    has_time_code : bool, default False
        Whether the file tells how far its times are ahead of UTC.
    source : str, optional
        File it was read from, for messages.
    """

    samples: NDArray[np.float64]
    sample_rate_hz: float
    start_time_ns: int | None
    channels: tuple[Channel, ...]
    trigger_index: int | None = None
    nominal_frequency_hz: float | None = None
    station: str = ""
    device: str = ""
    digitals: Digitals | None = None
    instants_s: NDArray[np.float64] | None = None
    repairs: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    has_time_code: bool = field(default=False, compare=False)
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
    def first_time_ns(self) -> int:
        """UTC of the first sample [ns since 1970].

        Raises
        ------
        UnknownTimeError
            If the file tells no time: what is put in the order of time must not have a false one.
        """
        if self.start_time_ns is None:
            raise UnknownTimeError(
                self.source, "time", expected="a date and time in the file", found="none that can be read"
            )
        return self.start_time_ns

    @property
    def trigger_time_ns(self) -> int:
        """UTC of the trigger, or of the first sample where the file names no trigger [ns since 1970].

        Raises
        ------
        UnknownTimeError
            If the file tells no time.
        """
        index = self.trigger_index or 0
        if self.instants_s is not None:
            return self.first_time_ns + round(float(self.instants_s[index]) * NANOSECONDS_PER_SECOND)
        return self.first_time_ns + round(index / self.sample_rate_hz * NANOSECONDS_PER_SECOND)


def _last_step(instants_s: NDArray[np.float64], sample_rate_hz: float) -> float:
    return float(instants_s[-1] - instants_s[-2]) if instants_s.size > 1 else 1 / sample_rate_hz
