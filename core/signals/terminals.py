"""What the machine models need of a recording: terminal currents, and terminal voltages in Clarke axes."""

import re
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import groupby
from math import ceil, inf, isfinite

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError
from core.recordings.resampling import evenly_spaced
from core.recordings.waveform import REVERSED_LINES, Channel, Quantity, Recording
from core.signals.clarke import CLARKE, CLARKE_FROM_LINE
from core.signals.refusals import listing, reasons

PHASES = ("a", "b", "c")
LINES = ("ab", "bc", "ca")
RESIDUAL = re.compile(r"3?[Ii]_?[0oOGgEeNn]|.*(?:RES|GND|EARTH|GROUND|NEUTRAL).*", re.IGNORECASE)
"""Names of channels in A that are of no phase."""
WINDINGS_TO_LINES = np.array([[1.0, 0.0, -1.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])
"""Line currents of a delta from those of its windings ab, bc, ca."""

_WORDS = {
    Quantity.CURRENT: "phase current",
    Quantity.PHASE_VOLTAGE: "phase voltage",
    Quantity.LINE_VOLTAGE: "line voltage",
}


class VoltageChannels(StrEnum):
    """Which voltages a recorder measures; it decides what an error of one channel looks like."""

    PHASE = "phase"
    THREE_LINES = "three-lines"
    TWO_LINES = "two-lines"


@dataclass(frozen=True, slots=True)
class Terminals:
    """Quantities at the motor's terminals, on the time base of the recording; missing samples stay NaN.

    Parameters
    ----------
    current_abc : ndarray, shape (3, n)
        Line currents of terminals a, b, c [A].
    voltage_ab : ndarray or None, shape (2, n)
        Voltages on power-invariant Clarke axes [V]; None if the recording has none.
    sample_rate_hz : float
        Sampling rate [Hz].
    current_channels : tuple of Channel
        The three current channels taken.
    voltage_channels : tuple of Channel
        The voltage channels taken: three, two where the third line voltage follows from Kirchhoff's law, none
        without voltages.
    voltages : ndarray, shape (channels, n)
        Samples of the voltage channels [V].
    voltage_axes : ndarray, shape (2, channels)
        Matrix that makes voltage_ab of the voltages.
    voltage_quantity : Quantity or None
        Whether they are phase or line voltages; None without voltages.
    computed_current : str or None, optional
        The phase without a current transformer, whose current is minus the sum of the other two; None where
        all three are measured.
    """

    current_abc: NDArray[np.float64]
    voltage_ab: NDArray[np.float64] | None
    sample_rate_hz: float
    current_channels: tuple[Channel, ...]
    voltage_channels: tuple[Channel, ...]
    voltages: NDArray[np.float64]
    voltage_axes: NDArray[np.float64]
    voltage_quantity: Quantity | None
    computed_current: str | None = None

    @property
    def voltages_measured(self) -> VoltageChannels | None:
        """Which voltages are measured; None without any."""
        if self.voltage_quantity is None:
            return None
        if self.voltage_quantity is Quantity.PHASE_VOLTAGE:
            return VoltageChannels.PHASE
        return VoltageChannels.THREE_LINES if len(self.voltage_channels) == 3 else VoltageChannels.TWO_LINES


def terminals(
    recording: Recording,
    *,
    currents: tuple[str, str, str] | None = None,
    phase_voltages: tuple[str, str, str] | None = None,
    line_voltages: tuple[str, str, str] | None = None,
    longest_s: float = inf,
    voltage_ratio: float | None = None,
    current_ratio: float | None = None,
    inside_delta: bool = False,
) -> Terminals:
    """Pick the terminal quantities by channel name, or by quantity and phase where no names are given.

    Of currents two phases suffice, where no other channel may be the third: three wires carry a sum of zero.

    Voltages are phase voltages if named, else line voltages if named, else a complete set of phase voltages,
    else of line voltages (two suffice, for they sum to zero), else None.

    Parameters
    ----------
    recording : Recording
        The recording.
    currents : tuple of str or None, optional
        Names of the channels of i_a, i_b, i_c.
    phase_voltages : tuple of str or None, optional
        Names of the channels of v_a, v_b, v_c.
    line_voltages : tuple of str or None, optional
        Names of the channels of v_ab, v_bc, v_ca.
    longest_s : float, default inf
        Of a longer record only the end is taken [s].
    voltage_ratio, current_ratio : float or None, optional
        Ratios of the instrument transformers by which the values as written are multiplied, instead of what
        the recording says; None for what it says.
    inside_delta : bool, default False
        Whether the currents are those of the windings ab, bc, ca inside a delta.

    Returns
    -------
    Terminals
        The terminal quantities.

    Raises
    ------
    RecordingError
        If a channel is missing, ambiguous or of the wrong unit, or the sample rate or the samples are no real
        numbers or have a gap.
    """
    if not (isfinite(recording.sample_rate_hz) and recording.sample_rate_hz > 0.0):
        raise RecordingError(
            recording.source, "sample rate", expected="more than 0 Hz", found=f"{recording.sample_rate_hz} Hz"
        )
    recording = evenly_spaced(recording)
    if recording.samples.dtype.kind not in "fiu":
        raise RecordingError(
            recording.source, "samples", expected="real numbers", found=f"{recording.samples.dtype}"
        )
    by_phase = _named_currents(recording, currents) if currents else _find_currents(recording)
    missing = next((phase for phase in PHASES if phase not in by_phase), None)
    if missing and inside_delta:
        raise RecordingError(
            recording.source,
            f"current of phase {missing}",
            expected="currents of all three windings, as the transformers are inside the delta",
            found=reasons(recording, Quantity.CURRENT),
        )
    voltage_quantity, voltage_rows, voltage_axes = _voltages(recording, phase_voltages, line_voltages)
    longest = min(longest_s * recording.sample_rate_hz, recording.samples.shape[1])
    first = recording.samples.shape[1] - ceil(longest)
    rows = tuple(by_phase[phase] for phase in PHASES if phase in by_phase)
    currents_abc, current_channels = _primary(recording, rows, first, current_ratio)
    if missing:
        currents_abc, current_channels = _completed(currents_abc, current_channels, missing)
    if inside_delta:
        with np.errstate(invalid="ignore"):  # infinite samples become NaN and stay so
            currents_abc = WINDINGS_TO_LINES @ currents_abc
    voltages, voltage_channels = _primary(recording, voltage_rows, first, voltage_ratio)
    with np.errstate(invalid="ignore", over="ignore"):  # infinite samples become NaN and stay so
        voltage_ab = voltage_axes @ voltages
    return Terminals(
        current_abc=currents_abc,
        voltage_ab=voltage_ab if voltage_rows else None,
        sample_rate_hz=recording.sample_rate_hz,
        current_channels=current_channels,
        voltage_channels=voltage_channels,
        voltages=voltages,
        voltage_axes=voltage_axes,
        voltage_quantity=voltage_quantity,
        computed_current=missing,
    )


def _completed(
    measured: NDArray[np.float64], channels: tuple[Channel, ...], missing: str
) -> tuple[NDArray[np.float64], tuple[Channel, ...]]:
    """Return currents and channels of all phases, the missing one as minus the sum of the two."""
    at = PHASES.index(missing)
    with np.errstate(invalid="ignore", over="ignore"):
        current = -measured.sum(axis=0)
    name = f"-({' + '.join(channel.name for channel in channels)})"
    channel = Channel(name, Quantity.CURRENT, missing, channels[0].unit)
    return np.insert(measured, at, current, axis=0), (*channels[:at], channel, *channels[at:])


def _primary(
    recording: Recording, rows: tuple[int, ...], first: int, ratio: float | None
) -> tuple[NDArray[np.float64], tuple[Channel, ...]]:
    """Return samples and channels; with a ratio of the motor's own, that instead of the recording's."""
    samples = recording.samples[:, first:][list(rows)].astype(np.float64, copy=False)
    channels = [recording.channels[row] for row in rows]
    if any(channel.phase in REVERSED_LINES for channel in channels):
        signs = np.array([-1.0 if channel.phase in REVERSED_LINES else 1.0 for channel in channels])
        samples = samples * signs[:, np.newaxis]
    if ratio is None:
        return samples, tuple(channels)
    factors = np.array([ratio / channel.applied_ratio for channel in channels])
    with np.errstate(over="ignore"):
        samples = samples * factors[:, np.newaxis]
    return samples, tuple(map(_with_ratio, channels, factors.tolist(), [ratio] * len(channels)))


def _with_ratio(channel: Channel, factor: float, ratio: float) -> Channel:
    full_scale = None if channel.full_scale is None else channel.full_scale * factor
    return replace(channel, full_scale=full_scale, transformer_ratio=ratio, applied_ratio=ratio)


def _voltages(
    recording: Recording,
    phase_voltages: tuple[str, str, str] | None,
    line_voltages: tuple[str, str, str] | None,
) -> tuple[Quantity | None, tuple[int, ...], NDArray[np.float64]]:
    """Find what voltages there are, rows of their channels, and the matrix that makes Clarke axes of them."""
    phase, line = Quantity.PHASE_VOLTAGE, Quantity.LINE_VOLTAGE
    if phase_voltages:
        return phase, _by_name(recording, phase, phase_voltages), CLARKE
    if line_voltages:
        return line, _by_name(recording, line, line_voltages), CLARKE_FROM_LINE
    by_phase = _find(recording, phase, PHASES)
    if len(by_phase) == len(PHASES):
        return phase, tuple(by_phase[name] for name in PHASES), CLARKE
    by_line = _find(recording, line, LINES)
    if len(by_line) >= 2:
        return line, tuple(by_line.values()), CLARKE_FROM_LINE @ _closed_triangle(by_line)
    if by_phase or by_line:
        raise RecordingError(
            recording.source,
            "voltages",
            expected="three phase voltages, or at least two line voltages",
            found=reasons(recording, line),
        )
    return None, (), np.zeros((2, 0))


def _closed_triangle(by_line: dict[str, int]) -> NDArray[np.float64]:
    """From the line voltages there are to all three: one not recorded is minus the sum of the others."""
    rows = [
        [float(line == other) for other in by_line] if line in by_line else [-1.0] * len(by_line)
        for line in LINES
    ]
    return np.array(rows)


def _named_currents(recording: Recording, names: tuple[str, str, str]) -> dict[str, int]:
    return dict(zip(PHASES, _by_name(recording, Quantity.CURRENT, names), strict=True))


def _find_currents(recording: Recording) -> dict[str, int]:
    found = _find(recording, Quantity.CURRENT, PHASES)
    missing = [phase for phase in PHASES if phase not in found]
    if not missing or (len(missing) == 1 and not _may_be_a_phase(recording)):
        return found
    raise RecordingError(
        recording.source,
        f"current of phase {', '.join(missing)}",
        expected="one current channel for each of phases a, b, c, or for two of them and no other "
        "(or name them in the motor's channels)",
        found=reasons(recording, Quantity.CURRENT),
    )


def _may_be_a_phase(recording: Recording) -> bool:
    """Whether a sampled current of unknown phase may be the one that is missing."""
    return any(
        channel.quantity is Quantity.CURRENT
        and channel.phase is None
        and not channel.is_constant
        and not RESIDUAL.fullmatch(channel.name)
        for channel in recording.channels
    )


def _find(recording: Recording, quantity: Quantity, phases: tuple[str, str, str]) -> dict[str, int]:
    """Row of the one channel of each phase there is; two channels of one phase are an error."""
    known = {phase: phase for phase in phases} | REVERSED_LINES
    rows = [
        (phases.index(known[channel.phase]), row)
        for row, channel in enumerate(recording.channels)
        if channel.quantity is quantity
        and channel.phase is not None
        and known.get(channel.phase) in phases
        and not channel.is_constant
    ]
    found: dict[str, int] = {}
    for index, group in groupby(sorted(rows), key=lambda item: item[0]):
        candidates = [row for _, row in group]
        if len(candidates) > 1:
            raise RecordingError(
                recording.source,
                f"{_WORDS[quantity]} {phases[index]}",
                expected="one channel (name the motor's own in its channels)",
                found=listing(recording.channels[row] for row in candidates),
            )
        found[phases[index]] = candidates[0]
    return found


def _by_name(recording: Recording, quantity: Quantity, names: tuple[str, str, str]) -> tuple[int, ...]:
    return tuple(_row_of(recording, quantity, name) for name in names)


def _row_of(recording: Recording, quantity: Quantity, name: str) -> int:
    rows = [row for row, channel in enumerate(recording.channels) if channel.name == name]
    if len(rows) != 1:
        raise RecordingError(
            recording.source,
            f"channel {name!r}",
            expected="exactly one channel of this name",
            found=listing(recording.channels[row] for row in rows or range(len(recording.channels))),
        )
    unit = "A" if quantity is Quantity.CURRENT else "V"
    channel = recording.channels[rows[0]]
    if channel.unit != unit:
        raise RecordingError(
            recording.source,
            f"channel {name!r}",
            expected=f"a {_WORDS[quantity]} in {unit}",
            found=f"unit {channel.unit!r}",
        )
    if channel.is_constant:
        raise RecordingError(
            recording.source,
            f"channel {name!r}",
            expected="a channel that was sampled",
            found="a constant: its multiplier is 0 in the configuration",
        )
    return rows[0]
