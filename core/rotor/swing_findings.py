"""What a record tells of the air gap, and of a load that swings; what finds it is beside this module."""

from dataclasses import dataclass

EVEN_GAP = 0.004
"""Ripple of the permeance of a sound motor, a tenth of static times a twentieth of dynamic eccentricity."""
STEADY_LOAD = 0.004
"""Swing of a steady load's torque over the rated one, rms."""


@dataclass(frozen=True, slots=True)
class EccentricityFinding:
    """What a record tells of the air gap; figures are None where it cannot tell them.

    Parameters
    ----------
    permeance_ripple : float or None
        Amplitude of the relative ripple of the gap's permeance, once a turn.
    standard_deviation : float or None
        Its standard deviation: noise, and the parameters of the model.
    detection_limit : float or None
        Ripple that nine of ten such records show.
    lower_sideband_dB, upper_sideband_dB : float or None
        Current at f - f_r and f + f_r as measured, over the fundamental [dB].
    load_torque : float or None
        Torque of the load that swings once a turn, its amplitude over rated torque.
    load_torque_deviation : float or None
        Its standard deviation, over rated torque.
    rotation_frequency_hz : float or None
        Frequency f_r at which the lines stand [Hz].
    reasons : tuple of str
        What limits the figures, in words.
    """

    permeance_ripple: float | None = None
    standard_deviation: float | None = None
    detection_limit: float | None = None
    lower_sideband_dB: float | None = None
    upper_sideband_dB: float | None = None
    load_torque: float | None = None
    load_torque_deviation: float | None = None
    rotation_frequency_hz: float | None = None
    reasons: tuple[str, ...] = ()

    @classmethod
    def untold(cls, reason: str) -> "EccentricityFinding":
        """Return the finding of a record that tells nothing of the gap.

        Parameters
        ----------
        reason : str
            Why, in words.

        Returns
        -------
        EccentricityFinding
            The finding.
        """
        return cls(reasons=(reason,))

    def as_dict(self) -> dict[str, object]:
        """Return the part `eccentricity` of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        figures = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return figures | {"reasons": list(self.reasons)}


@dataclass(frozen=True, slots=True)
class PulsationFinding:
    """The strongest swing of the load's torque; figures are None where a record cannot tell them.

    Parameters
    ----------
    load_torque : float or None
        Its amplitude over rated torque.
    noise : float or None
        What noise makes of it, rms, over rated torque.
    frequency_hz : float or None
        Its frequency [Hz].
    reasons : tuple of str
        What limits the figures, in words.
    """

    load_torque: float | None = None
    noise: float | None = None
    frequency_hz: float | None = None
    reasons: tuple[str, ...] = ()

    @classmethod
    def untold(cls, reason: str) -> "PulsationFinding":
        """Return the finding of a record that tells nothing of swings.

        Parameters
        ----------
        reason : str
            Why, in words.

        Returns
        -------
        PulsationFinding
            The finding.
        """
        return cls(reasons=(reason,))

    def as_dict(self) -> dict[str, object]:
        """Return the part `pulsation` of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        return {
            "load_torque": self.load_torque,
            "noise": self.noise,
            "frequency_hz": self.frequency_hz,
            "reasons": list(self.reasons),
        }
