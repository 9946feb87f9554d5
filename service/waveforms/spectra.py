"""The spectrum of a recording's currents, with the lines that matter for its motor."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.recordings import RecordingError
from core.signals.errors import SignalError
from core.signals.spectrum import MAIN_LOBE_BINS, SpectralLine, amplitude_spectrum, lines_of_a_motor
from core.signals.terminals import PHASES
from core.units import SECONDS_PER_MINUTE
from service.waveforms.opened import Opened
from service.waveforms.phasors import NoPhasorsError, frequency_near

HIGHEST_ORDER: Final = 25.0
"""Lines above this multiple of the supply's frequency are left out."""
MOST_SAMPLES: Final = 1 << 19
"""Of a longer recording the end is taken."""
LEAST_AMPLITUDE: Final = 1e-6
"""Share of the strongest line below which an amplitude is drawn as nothing: -120 dB."""


class NoSpectrumError(ValueError):
    """The recording has no spectrum; the message says why."""


@dataclass(frozen=True, slots=True)
class FoundLine:
    """A line to look for, and what is there.

    amplitude_A: rms, by phase.  level_dB: of the largest, beside the strongest line of all.
    """

    line: SpectralLine
    amplitude_A: tuple[float, float, float]
    level_dB: float


@dataclass(frozen=True, slots=True)
class CurrentSpectrum:
    """The spectrum of the three line currents.

    frequency_hz, level_dB: shape (3, lines), beside the strongest line; of several lines that share a place
    the largest is kept.  resolution_hz: least distance of lines that are told apart.  lines: those that the
    supply's own line does not cover, which leaks so far to both sides.  slip: None where the
    speed is not known.  seconds_for_sidebands: how long a recording has to be for the sidebands of broken
    bars to be told from the supply's line; None without a slip.
    """

    first_s: float
    last_s: float
    supply_hz: float
    resolution_hz: float
    frequency_hz: NDArray[np.float64]
    level_dB: NDArray[np.float64]
    lines: tuple[FoundLine, ...]
    slip: float | None
    seconds_for_sidebands: float | None

    @property
    def tells_sidebands(self) -> bool:
        """Tell whether the recording is long enough for the sidebands of broken bars."""
        needed = self.seconds_for_sidebands
        return needed is not None and self.last_s - self.first_s >= needed


def spectrum_of(
    shown: Opened, points: int, *, speed_rpm: float | None = None, slip: float | None = None
) -> CurrentSpectrum:
    """Return the spectrum of the currents. Raises NoSpectrumError.

    points: most lines of the drawn spectrum.  speed_rpm: of the shaft, as the diagnosis found it.
    slip: as the rotor was examined with; by default it follows from the speed.
    """
    try:
        measured = shown.terminals()
        currents = measured.current_abc[:, -MOST_SAMPLES:]
        rate = measured.sample_rate_hz
        before = measured.current_abc.shape[1] - currents.shape[1]
        middle_s = (before + currents.shape[1] / 2.0) / rate
        supply_hz, _ = frequency_near(shown, measured, middle_s)
        spectrum = amplitude_spectrum(currents, rate)
    except (RecordingError, SignalError, NoPhasorsError) as error:
        raise NoSpectrumError(str(error)) from error
    highest = min(HIGHEST_ORDER * supply_hz, float(spectrum.frequency_hz[-1]))
    slip = _slip(shown, supply_hz, speed_rpm) if slip is None else slip
    strongest = float(spectrum.amplitude.max()) or 1.0
    frequencies, amplitudes = _thinned(spectrum.frequency_hz, spectrum.amplitude, highest, points)
    lines = lines_of_a_motor(
        supply_hz,
        highest,
        slip=slip,
        pole_pairs=None if shown.motor is None else shown.motor.nameplate.pole_pairs,
        rotor_bars=None if shown.motor is None else shown.motor.nameplate.rotor_bars,
    )
    lines = tuple(one for one in lines if _is_resolved(one, supply_hz, spectrum.resolution_hz))
    found = [_found(one, spectrum.frequency_hz, spectrum.amplitude, spectrum.resolution_hz) for one in lines]
    return CurrentSpectrum(
        first_s=before / rate,
        last_s=(before + currents.shape[1]) / rate,
        supply_hz=supply_hz,
        resolution_hz=spectrum.resolution_hz,
        frequency_hz=frequencies,
        level_dB=_decibels(amplitudes, strongest),
        lines=tuple(
            FoundLine(line, (a[0], a[1], a[2]), float(_decibels(np.max(a), strongest))) for line, a in found
        ),
        slip=slip,
        seconds_for_sidebands=None if not slip else MAIN_LOBE_BINS / (2.0 * abs(slip) * supply_hz),
    )


def _slip(shown: Opened, supply_hz: float, speed_rpm: float | None) -> float | None:
    if speed_rpm is None or shown.motor is None:
        return None
    return 1.0 - speed_rpm / SECONDS_PER_MINUTE * shown.motor.nameplate.pole_pairs / supply_hz


def _is_resolved(line: SpectralLine, supply_hz: float, resolution_hz: float) -> bool:
    """Tell whether a line is the supply's, or so far from it that something else than its leakage is seen.

    That is its width on one side, and half of that again on both sides of the place that is looked at.
    """
    distance_hz = abs(line.frequency_hz - supply_hz)
    return distance_hz == 0.0 or distance_hz >= 2.0 * resolution_hz


def _found(
    line: SpectralLine,
    frequencies: NDArray[np.float64],
    amplitudes: NDArray[np.float64],
    resolution_hz: float,
) -> tuple[SpectralLine, list[float]]:
    near = np.abs(frequencies - line.frequency_hz) <= resolution_hz / 2.0
    if not near.any():
        near = np.arange(frequencies.size) == int(np.argmin(np.abs(frequencies - line.frequency_hz)))
    return line, [float(amplitudes[row, near].max()) for row in range(len(PHASES))]


def _thinned(
    frequencies: NDArray[np.float64], amplitudes: NDArray[np.float64], highest: float, points: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    count = int(np.searchsorted(frequencies, highest, side="right"))
    kept, values = frequencies[:count], amplitudes[:, :count]
    if count <= points:
        return kept, values
    starts = np.unique(np.linspace(0, count, num=points, endpoint=False).astype(np.intp))
    ends = np.append(starts[1:], count)
    # The line that is kept stands where it was, not at the beginning of its interval.
    strongest = np.array(
        [a + int(np.argmax(values[:, a:b].max(axis=0))) for a, b in zip(starts, ends, strict=True)]
    )
    return kept[strongest], np.maximum.reduceat(values, starts, axis=1)


def _decibels(amplitude: NDArray[np.float64] | float, strongest: float) -> NDArray[np.float64]:
    return np.asarray(20.0 * np.log10(np.maximum(np.asarray(amplitude) / strongest, LEAST_AMPLITUDE)))
