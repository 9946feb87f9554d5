"""Phasors and symmetrical components of one cycle of a recording."""

from cmath import exp as cexp
from cmath import phase as angle
from dataclasses import dataclass
from math import isfinite, pi
from typing import Final

import numpy as np

from core.recordings import Quantity, RecordingError
from core.signals.clarke import CLARKE, clarke
from core.signals.errors import SignalError
from core.signals.phasors import USUAL_SEARCH_HZ, fundamental_frequency, harmonic_phasors
from core.signals.sequence import PhaseSequence, SequencePhasors, sequence_phasors
from core.signals.terminals import PHASES, Terminals
from service.waveforms.opened import Opened

FREQUENCY_WINDOW_S: Final = 0.5
"""The frequency is found in so much of the recording around the cycle."""


class NoPhasorsError(ValueError):
    """The recording has no phasors there; the message says why."""


@dataclass(frozen=True, slots=True)
class NamedPhasor:
    """An rms phasor with its name, such as "Va" or "I2". Angles count from `PhasorsAt.reference`."""

    name: str
    value: complex
    unit: str


@dataclass(frozen=True, slots=True)
class PhasorsAt:
    """Phasors of the cycle around a time.

    at_s: middle of the cycle after the first sample of the recording [s].  zero_angle_s: when the reference
    had the angle nought, so that recordings can be laid over one another [s].  sequence: order of the phases.
    phases: of the terminals.  components: positive, negative and, where it was measured, zero sequence, of
    the supply's own order.  reference: what angles count from.  is_assumed: whether the frequency is the
    rated one, because none could be found.
    """

    at_s: float
    zero_angle_s: float
    frequency_hz: float
    is_assumed: bool
    sequence: PhaseSequence
    reference: str
    phases: tuple[NamedPhasor, ...]
    components: tuple[NamedPhasor, ...]

    def component(self, name: str) -> complex | None:
        """Return a component by its name, such as "V2"; None where there is none."""
        return next((one.value for one in self.components if one.name == name), None)

    def ratio(self, weaker: str, stronger: str) -> float | None:
        """Return the ratio of two components' sizes; None where one is missing or the stronger is nothing."""
        one, other = self.component(weaker), self.component(stronger)
        if one is None or other is None or abs(other) == 0.0:
            return None
        return abs(one) / abs(other)

    @property
    def active_power_W(self) -> float | None:
        """Return the power of the positive sequence [W]; None without voltages."""
        volts, amperes = self.component("V1"), self.component("I1")
        return None if volts is None or amperes is None else 3.0 * (volts * amperes.conjugate()).real

    @property
    def power_factor(self) -> float | None:
        """Return the cosine of the angle between voltage and current of the positive sequence."""
        volts, amperes = self.component("V1"), self.component("I1")
        if volts is None or amperes is None or abs(volts) * abs(amperes) == 0.0:
            return None
        return (volts * amperes.conjugate()).real / (abs(volts) * abs(amperes))


def phasors_at(shown: Opened, at_s: float) -> PhasorsAt:
    """Return the phasors of the cycle around a time, or of the nearest whole one. Raises NoPhasorsError."""
    try:
        measured = shown.terminals()
        return _phasors(shown, measured, at_s)
    except (RecordingError, SignalError) as error:
        raise NoPhasorsError(str(error)) from error


def frequency_near(shown: Opened, measured: Terminals, at_s: float) -> tuple[float, bool]:
    """Return the supply's frequency around a time, and whether it is the rated one for want of another.

    Raises NoPhasorsError.
    """
    rate = measured.sample_rate_hz
    axes = clarke(measured.current_abc) if measured.voltage_ab is None else measured.voltage_ab
    first, last = _around(at_s, FREQUENCY_WINDOW_S, rate, axes.shape[1])
    search = shown.motor.nameplate.frequency_range_Hz if shown.motor else USUAL_SEARCH_HZ
    try:
        return fundamental_frequency(axes[:, first:last], rate, search_hz=search), False
    except SignalError:
        rated = shown.motor.nameplate.rated_frequency_Hz if shown.motor else None
        known = shown.recording.nominal_frequency_hz or rated
        if known is None or not isfinite(known) or known <= 0.0:
            raise NoPhasorsError("no supply frequency can be found, and the file names none") from None
        return known, True


def _phasors(shown: Opened, measured: Terminals, at_s: float) -> PhasorsAt:
    frequency_hz, is_assumed = frequency_near(shown, measured, at_s)
    rate = measured.sample_rate_hz
    count = measured.current_abc.shape[1]
    first, last = _around(at_s, 1.0 / frequency_hz, rate, count)
    if (last - first) < round(rate / frequency_hz):
        raise NoPhasorsError(f"{count} samples at {rate:g} Hz are less than a cycle of {frequency_hz:.4g} Hz")
    currents = harmonic_phasors(measured.current_abc[:, first:last], frequency_hz, rate)[:, 0]
    phases = [NamedPhasor(f"I{p}", complex(i), "A") for p, i in zip(PHASES, currents, strict=True)]
    systems = {"I": sequence_phasors(CLARKE @ currents)}
    zeros = {"I": complex(currents.mean())}
    if measured.voltage_ab is not None:
        volts = harmonic_phasors(measured.voltages[:, first:last], frequency_hz, rate)[:, 0]
        names = [channel.phase or channel.name for channel in measured.voltage_channels]
        if measured.voltage_quantity is Quantity.PHASE_VOLTAGE:
            names, zeros["V"] = list(PHASES), complex(volts.mean())
        phases = [
            *(NamedPhasor(f"V{name}", complex(v), "V") for name, v in zip(names, volts, strict=True)),
            *phases,
        ]
        systems = {"V": sequence_phasors(np.asarray(measured.voltage_axes @ volts)), **systems}
    leading = next(iter(systems.values()))
    order = leading.sequence
    reference_angle = angle(_forward(leading, order))
    turned = cexp(-1j * reference_angle)
    components = [
        NamedPhasor(name, value * turned, "V" if name.startswith("V") else "A")
        for letter, system in systems.items()
        for name, value in _components(letter, system, order, zeros.get(letter))
    ]
    return PhasorsAt(
        at_s=(first + last - 1) / 2.0 / rate,
        zero_angle_s=first / rate - reference_angle / (2.0 * pi * frequency_hz),
        frequency_hz=frequency_hz,
        is_assumed=is_assumed,
        sequence=order,
        reference="V1" if "V" in systems else "I1",
        phases=tuple(NamedPhasor(one.name, one.value * turned, one.unit) for one in phases),
        components=tuple(components),
    )


def _forward(system: SequencePhasors, order: PhaseSequence) -> complex:
    return system.positive if order is PhaseSequence.ABC else system.negative


def _components(
    letter: str, system: SequencePhasors, order: PhaseSequence, zero: complex | None
) -> list[tuple[str, complex]]:
    forward, backward = system.positive, system.negative
    if order is PhaseSequence.ACB:
        forward, backward = backward, forward
    found = [(f"{letter}1", forward), (f"{letter}2", backward)]
    return found if zero is None else [*found, (f"{letter}0", zero)]


def _around(at_s: float, length_s: float, rate: float, count: int) -> tuple[int, int]:
    length = min(round(length_s * rate), count)
    first = min(max(round(at_s * rate) - length // 2, 0), count - length)
    return first, first + length
