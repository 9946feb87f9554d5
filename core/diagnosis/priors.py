"""What is known of offsets, loads, channels and parameters before a record is compared.

A fit compares four real figures, the forward- and the backward-turning current. Level, load, offset and the
leakage of the turns are more unknowns than the record alone can decide between. What decides is how far
offsets and loads of real plants go, and what sensors and parameters make of the currents
(`core.diagnosis.record_errors`).
"""

from math import hypot

from core.machines.sensors import SensorClass

OFFSET_S, LONG_OFFSET_S = 100e-6, 1e-3
"""Standard deviations of the offset between a relay's currents and voltages: of nearly all relays, and of
those with a filter or a setting in only one of the two."""
LONG_OFFSETS = 0.01
"""Share of the relays with a long offset."""
GENERATING = 0.05
"""Load below zero that counts as one standard deviation: a motor drives, but its no-load losses are not
known exactly."""
TOGETHER = 0.7
"""Share of the tolerances' sum that counts: parameters are rarely all wrong in the same direction."""
SATURATION = 1.0
"""Relative loss of magnetising inductance per relative rise of voltage or flux above the rated one."""
IRON, IRON_EXPONENT = 0.12, 9.0
"""Share of the rated magnetising current that the iron needs, and the exponent of its rise over the flux. The
magnetising inductance is less by 12 % at 110 % of the rated flux, and greater by 7 % at 90 %; of motors of
usual sheet steel it is less by 5 to 25 %."""
SATURATION_SPREAD = 1.0
"""Standard deviation of what motors lose more or less than that, per relative rise of the flux."""
MISFIT = 0.04
"""Misfit of the model of shorted turns, a share of what they change of each current (complex magnitude):
harmonics of a coil, the speed's ripple."""
UNKNOWN_ASYMMETRY = 0.02
"""Standard deviation of an asymmetry of unknown cause, a share of V1 (complex magnitude)."""


def saturated_share(relative_flux: float) -> float:
    """Return the magnetising inductance of usual iron over the rated one, at a flux over the rated one."""
    needed: float = 1.0 - IRON + IRON * relative_flux ** (IRON_EXPONENT - 1.0)
    return 1.0 / needed


def gain_deviation(sensors: SensorClass) -> float:
    """Return the standard deviation of the mean of three currents' ratios over that of three voltages'."""
    return hypot(sensors.current_gain, sensors.voltage_gain) / 3.0


def offset_deviation_s(sensors: SensorClass) -> float:
    """Return the standard deviation of the offset between currents and voltages."""
    return hypot(OFFSET_S, sensors.current_delay_s / 3.0, sensors.voltage_delay_s / 3.0)
