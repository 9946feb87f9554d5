"""What a record tells of the rotor's cage."""

from dataclasses import dataclass
from enum import StrEnum
from math import log10
from typing import Self

LOWEST_DB = -120.0
"""What is less is written so."""
LOAD_OSCILLATION = "load oscillation"
"""So begins the reason that tells of one."""
LOAD_BINS, BINS_PER_RATED_LOAD = 12, 10
"""Loads up to 1.2 times the rated one in tenths of it."""


class RotorState(StrEnum):
    """What a record, or a motor's records together, say of the rotor's cage."""

    HEALTHY = "healthy"
    WATCH = "watch"
    FAULT = "fault"
    UNSUPPORTED = "unsupported"
    """The record cannot tell; the reasons say why."""


@dataclass(frozen=True, slots=True)
class RotorFinding:
    """What a record tells of the rotor's cage; figures are None where it cannot tell them.

    Parameters
    ----------
    state : RotorState
        Healthy, watch, fault, or unsupported.
    lower_sideband_dB, upper_sideband_dB : float or None
        Current at (1 - 2s) f and (1 + 2s) f as measured, over the fundamental [dB].
    severity_dB : float or None
        Asymmetry of the rotor's resistance, half the difference of its axes over its value [dB]. It is the
        lower sideband over the rotor's current that a rotor of steady speed would have; load and inertia do
        not change it. A cage that lost n of N neighbouring bars has a little less than n / N.
    severity_dB_ci95 : tuple of float or None
        Its 95 % interval: noise, and the parameters of the model.
    detection_limit_dB : float or None
        Severity that nine of ten such records show.
    slip : float or None
        Slip: that seen in the current, else from the fit of the model.
    load_level : float or None
        Load torque over rated torque.
    load_bin : int or None
        Tenth of 1.2 times the rated load, 0 to 11.
    duration_s : float
        Length of the steady running that was examined [s].
    load_oscillation_dB : float or None
        Torque of the load that swings at 2 s f, its amplitude over rated torque [dB].
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: RotorState
    lower_sideband_dB: float | None
    upper_sideband_dB: float | None
    severity_dB: float | None
    severity_dB_ci95: tuple[float, float] | None
    detection_limit_dB: float | None
    slip: float | None
    load_level: float | None
    load_bin: int | None
    duration_s: float
    load_oscillation_dB: float | None
    reasons: tuple[str, ...]

    @classmethod
    def untold(cls, reason: str, duration_s: float) -> Self:
        """Return the finding of a record that tells nothing.

        Parameters
        ----------
        reason : str
            Why, in words.
        duration_s : float
            Length of the record [s].

        Returns
        -------
        RotorFinding
            The finding, without figures.
        """
        return cls(
            state=RotorState.UNSUPPORTED,
            lower_sideband_dB=None,
            upper_sideband_dB=None,
            severity_dB=None,
            severity_dB_ci95=None,
            detection_limit_dB=None,
            slip=None,
            load_level=None,
            load_bin=None,
            duration_s=duration_s,
            load_oscillation_dB=None,
            reasons=(reason,),
        )

    def as_dict(self) -> dict[str, object]:
        """Return the part `rotor` of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        interval = self.severity_dB_ci95
        return {
            "state": str(self.state),
            "lower_sideband_dB": self.lower_sideband_dB,
            "upper_sideband_dB": self.upper_sideband_dB,
            "severity_dB": self.severity_dB,
            "severity_dB_ci95": None if interval is None else list(interval),
            "detection_limit_dB": self.detection_limit_dB,
            "slip": self.slip,
            "load_level": self.load_level,
            "load_bin": self.load_bin,
            "duration_s": self.duration_s,
            "load_oscillation_dB": self.load_oscillation_dB,
            "reasons": list(self.reasons),
        }


def decibels(ratio: float) -> float:
    """Return a ratio of amplitudes in decibels.

    Parameters
    ----------
    ratio : float
        The ratio; one of zero or below is written as the lowest value.

    Returns
    -------
    float
        20 lg(ratio), not below LOWEST_DB [dB].
    """
    return max(LOWEST_DB, 20.0 * log10(ratio)) if ratio > 0.0 else LOWEST_DB


def load_bin(load_level: float) -> int:
    """Return the load bin, from 0 to 11.

    Parameters
    ----------
    load_level : float
        Load torque over rated torque.

    Returns
    -------
    int
        Tenth of the rated load; loads outside count to the first and the last bin.
    """
    return min(max(int(load_level * BINS_PER_RATED_LOAD), 0), LOAD_BINS - 1)
