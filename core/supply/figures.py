"""What a recording shows of a motor's supply, as figures."""

from dataclasses import dataclass

from core.reasoned_figures import ReasonedFigures


@dataclass(frozen=True, slots=True)
class SupplyFigures(ReasonedFigures):
    """Figures of the supply and of what the motor draws from it, over one recording.

    Harmonics are those of the line voltage, and of the line current, that is distorted most. They have as
    many orders as the sampling tells, 25 at most. Figures of the currents are None, and their harmonics
    empty, where no current flows.

    Parameters
    ----------
    frequency_hz : float
        Mean frequency of the supply [Hz].
    line_voltages_V : tuple of float
        Rms values of the fundamentals of v_ab, v_bc, v_ca [V].
    voltage_unbalance_iec : float
        |V2| / |V1| (IEC 61000-4-30, 5.7).
    voltage_unbalance_nema : float
        Largest deviation of a line voltage from their mean, over the mean (NEMA MG-1, 14.36).
    derating : float or None
        Factor of the rated power that the unbalance leaves (NEMA MG-1, 14.36); None above 5 %, where NEMA
        gives none and advises against running the motor.
    voltage_deviation : float
        Mean line voltage over rated voltage, minus 1.
    thd_voltage : float
        Total harmonic distortion of the voltage, over the fundamental (IEC 61000-4-7).
    harmonic_voltage_factor : float
        HVF (NEMA MG-1, 30.1.2.1): odd orders from 5 on, without multiples of 3, squares over the order.
    voltage_harmonics : tuple of float
        Orders 1, 2, 3 ... of the voltage, over the fundamental.
    line_currents_A : tuple of float or None
        Rms values of the fundamentals of i_a, i_b, i_c [A].
    current_unbalance : float or None
        |I2| / |I1|.
    thd_current : float or None
        Total harmonic distortion of the current, over the fundamental.
    current_harmonics : tuple of float
        Orders 1, 2, 3 ... of the current, over the fundamental.
    active_power_W : float or None
        Mean of the instantaneous power [W].
    power_factor : float or None
        Active power over effective apparent power (IEEE Std 1459, 3.2.2.8).
    duration_s : float
        Length of what was measured [s].
    reasons : tuple of str
        What limits the figures, in words.
    """

    frequency_hz: float
    line_voltages_V: tuple[float, float, float]
    voltage_unbalance_iec: float
    voltage_unbalance_nema: float
    derating: float | None
    voltage_deviation: float
    thd_voltage: float
    harmonic_voltage_factor: float
    voltage_harmonics: tuple[float, ...]
    line_currents_A: tuple[float, float, float] | None
    current_unbalance: float | None
    thd_current: float | None
    current_harmonics: tuple[float, ...]
    active_power_W: float | None
    power_factor: float | None
    duration_s: float
