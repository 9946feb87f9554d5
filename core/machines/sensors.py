"""How far a relay's channels, with their transformers, may be off."""

from dataclasses import dataclass
from math import hypot, pi, sqrt


@dataclass(frozen=True, slots=True)
class SensorClass:
    """Errors of single channels against one another, uniform within plus and minus each span.

    The default stands for protection relays with their transformers. A delay that all channels share shows in
    no phasor. What a delay makes of a phasor grows with the supply frequency.

    Parameters
    ----------
    voltage_gain, current_gain : float
        Span of the gains' relative errors: 0.01 is +-1 %.
    voltage_delay_s, current_delay_s : float
        Span of the delays [s]: 25e-6 is +-25 us.
    """

    voltage_gain: float = 0.01
    current_gain: float = 0.01
    voltage_delay_s: float = 25e-6
    current_delay_s: float = 25e-6

    def voltage_deviation(self, frequency_hz: float) -> float:
        """Return the standard deviation of a voltage channel's complex ratio.

        Parameters
        ----------
        frequency_hz : float
            Supply frequency [Hz].

        Returns
        -------
        float
            Root mean square of the ratio's relative error, in magnitude.
        """
        return _deviation(self.voltage_gain, self.voltage_delay_s, frequency_hz)

    def current_deviation(self, frequency_hz: float) -> float:
        """Return the standard deviation of a current channel's complex ratio.

        Parameters
        ----------
        frequency_hz : float
            Supply frequency [Hz].

        Returns
        -------
        float
            Root mean square of the ratio's relative error, in magnitude.
        """
        return _deviation(self.current_gain, self.current_delay_s, frequency_hz)


def _deviation(gain: float, delay_s: float, frequency_hz: float) -> float:
    return hypot(gain / sqrt(3.0), 2.0 * pi * frequency_hz * delay_s / sqrt(3.0))
