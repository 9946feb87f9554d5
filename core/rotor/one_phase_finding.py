"""What the current of one phase tells of the rotor's cage: level and change of its lower sideband."""

from dataclasses import dataclass
from math import hypot, log, sqrt

from core.machines.base import Array
from core.normal_distribution import NORMAL_95
from core.rotor.finding import RotorState, decibels
from core.rotor.one_phase import OnePhaseSidebands, one_phase_sidebands
from core.signals.errors import SignalError

HIGH_DB, LOW_DB = -45.0, -55.0
"""Lower sideband over the fundamental from which on a cage is suspect, and up to which it is sound. Measured
motors had -48 to -54 dB with whole cages and -42 to -50 dB with one broken bar: the level alone does not tell
what is between."""
REPEATABILITY_DB = 1.0
"""Standard deviation of a level from record to record at the same speed, beside noise."""
SEEN = 3.0
"""Amplitude of a sideband over the noise from which on there is one."""
DB_PER_NEPER = 20.0 / log(10.0)
WATCH_AT_MOST = (
    "one phase tells neither a load that swings nor a supply that pulsates from broken bars: never more than "
    "watch"
)


@dataclass(frozen=True, slots=True)
class OnePhaseFinding:
    """What the current of one phase tells of the rotor's cage.

    Parameters
    ----------
    state : RotorState
        Healthy, watch, or unsupported where it cannot tell.
    sidebands : OnePhaseSidebands or None
        What was measured; None where the record cannot tell it.
    slip : float
        Slip, from the speed.
    duration_s : float
        Length of the record [s].
    change_dB : float or None
        Lower sideband against that of the healthy record [dB]; None without one.
    change_dB_ci95 : tuple of float or None
        Its 95 % interval.
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: RotorState
    sidebands: OnePhaseSidebands | None
    slip: float
    duration_s: float
    change_dB: float | None
    change_dB_ci95: tuple[float, float] | None
    reasons: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        """Return the document that `mcc rotor --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name; None where they are not known.
        """
        found, interval = self.sidebands, self.change_dB_ci95
        return {
            "state": str(self.state),
            "lower_sideband_dB": None if found is None else decibels(found.lower),
            "upper_sideband_dB": None if found is None else decibels(found.upper),
            "noise_dB": None if found is None else decibels(found.noise),
            "change_dB": self.change_dB,
            "change_dB_ci95": None if interval is None else list(interval),
            "slip": self.slip,
            "distance_hz": None if found is None else found.distance_hz,
            "frequency_hz": None if found is None else found.frequency_hz,
            "duration_s": self.duration_s,
            "spikes": None if found is None else found.spikes,
            "reasons": list(self.reasons),
        }


def examine_one_phase(
    current: Array,
    sample_rate_hz: float,
    slip: float,
    rated_frequency_hz: float,
    healthy: OnePhaseSidebands | None = None,
) -> OnePhaseFinding:
    """Tell from one phase's current whether the rotor's cage may have broken bars.

    Parameters
    ----------
    current : ndarray, shape (n,)
        Samples in any unit.
    sample_rate_hz : float
        Sampling rate [Hz].
    slip : float
        Slip, from the speed.
    rated_frequency_hz : float
        Frequency near which the supply's is [Hz].
    healthy : OnePhaseSidebands or None, optional
        Sidebands of the same motor with a whole cage at about the same slip.

    Returns
    -------
    OnePhaseFinding
        State, figures and reasons; unsupported where the record cannot tell.
    """
    duration_s = current.size / sample_rate_hz
    try:
        found = one_phase_sidebands(current, sample_rate_hz, slip, rated_frequency_hz)
    except SignalError as error:
        return OnePhaseFinding(RotorState.UNSUPPORTED, None, slip, duration_s, None, None, (str(error),))
    if healthy is None:
        state, reason = _by_level(found)
        change_dB = interval = None
    else:
        change_dB = decibels(found.lower) - decibels(healthy.lower)
        spread = NORMAL_95 * hypot(_deviation_dB(found), _deviation_dB(healthy))
        interval = (change_dB - spread, change_dB + spread)
        state, reason = _by_change(found, change_dB, interval)
    reasons = (reason, WATCH_AT_MOST) if state is RotorState.WATCH else (reason,)
    return OnePhaseFinding(state, found, slip, duration_s, change_dB, interval, reasons)


def _by_level(found: OnePhaseSidebands) -> tuple[RotorState, str]:
    level_dB, noise_dB = decibels(found.lower), decibels(found.noise)
    told = f"the lower sideband has {level_dB:.1f} dB"
    if level_dB > HIGH_DB and found.lower > SEEN * found.noise:
        return RotorState.WATCH, f"{told}, above {HIGH_DB:g} dB, as broken bars make it"
    if max(level_dB, decibels(SEEN * found.noise)) <= LOW_DB:
        return RotorState.HEALTHY, f"{told}, below {LOW_DB:g} dB"
    return (
        RotorState.UNSUPPORTED,
        f"{told} (noise {noise_dB:.1f} dB), as whole cages have it and cages with a broken bar, too: compare "
        "it with a record of the same motor, known to be healthy, at the same speed",
    )


def _by_change(
    found: OnePhaseSidebands, change_dB: float, interval: tuple[float, float]
) -> tuple[RotorState, str]:
    told = (
        f"the lower sideband is {change_dB:+.1f} dB beside the healthy record's (95 %: {interval[0]:+.1f} to "
        f"{interval[1]:+.1f} dB)"
    )
    if interval[0] > 0.0 and found.lower > SEEN * found.noise:
        return RotorState.WATCH, f"{told}: it has risen, as with broken bars"
    return RotorState.HEALTHY, f"{told}: no more than such records differ"


def _deviation_dB(found: OnePhaseSidebands) -> float:
    by_noise = DB_PER_NEPER * found.noise / sqrt(2.0) / max(found.lower, found.noise)
    return hypot(by_noise, REPEATABILITY_DB)
