"""What a recorded start shows, as figures and as a curve."""

from dataclasses import dataclass
from math import sqrt


@dataclass(frozen=True, slots=True)
class StartCurve:
    """A start as it is drawn.

    Parameters
    ----------
    first_s : float
        Time of the first point after the switching, or after the record's first sample where the motor was
        switched on before [s].
    step_s : float
        Time between two points [s].
    current_A : tuple of float
        Rms of the three line currents over one step [A].
    voltage_V : tuple of float or None
        Rms voltage, line to line, over one step [V]; None where none was recorded.
    """

    first_s: float
    step_s: float
    current_A: tuple[float, ...]
    voltage_V: tuple[float, ...] | None


@dataclass(frozen=True, slots=True)
class MotorStart:
    """What a recorded start shows.

    Parameters
    ----------
    is_from_rest : bool
        Whether the record shows the motor being switched on; where it does not, it begins within the start.
    acceleration_s : float or None
        Time from the switching until the current has fallen nine tenths of the way from its starting to its
        running value [s]. None where the record does not show both ends.
    peak_current_A : float
        Greatest rms of the three line currents over one cycle [A].
    crest_current_A : float
        Greatest instantaneous current of a line [A].
    running_current_A : float or None
        Rms current once the motor runs [A]; None where the record ends before.
    lowest_voltage_V : float or None
        Least rms voltage over one cycle from the switching until the motor runs, or until the record ends,
        line to line [V]. None where no voltages were recorded.
    i2t_A2s : float
        Mean over the lines of the time integral of i^2 [A^2 s].
    i2t_over_s : float
        Length of that integral [s]: the acceleration time, or as much of the start as the record has.
    rated_current_A : float
        Rated current, estimated from rated power and voltage [A].
    rated_voltage_V : float
        Rated voltage, line to line [V].
    curve : StartCurve
        Current and voltage over time.
    """

    is_from_rest: bool
    acceleration_s: float | None
    peak_current_A: float
    crest_current_A: float
    running_current_A: float | None
    lowest_voltage_V: float | None
    i2t_A2s: float
    i2t_over_s: float
    rated_current_A: float
    rated_voltage_V: float
    curve: StartCurve

    @property
    def mean_current_A(self) -> float | None:
        """Root of the mean squared line current over the acceleration time [A]; None without that time."""
        if self.acceleration_s is None or not self.i2t_over_s > 0.0:
            return None
        return sqrt(self.i2t_A2s / self.i2t_over_s)
