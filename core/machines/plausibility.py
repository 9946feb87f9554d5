"""Ranges in which the figures of a real induction motor lie, whatever its size.

They are wide: no motor from 100 W to 20 MW is near an end. A figure outside is in another unit, belongs to
another field, or has a digit too many.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import sqrt

from core.machines.parameters import MAGNETISING_OVER_SELF, Nameplate
from core.quantity_text import plain

RATED_POWER_W = (10.0, 100e6)
RATED_VOLTAGE_V = (10.0, 50e3)
RATED_FREQUENCY_HZ = (10.0, 400.0)
MOST_POLE_PAIRS = 100
MOST_ROTOR_BARS = 1000
MOST_STATOR_SLOTS = 1000
LOCKED_ROTOR_CURRENT = (1.5, 20.0)
"""Locked rotor's current over the rated one."""
LOCKED_ROTOR_S = (0.5, 300.0)
MOST_STARTS_PER_HOUR = 1000
ROTOR_VOLTAGE_V = (10.0, 10e3)
"""Between the open slip rings of a wound rotor at standstill."""
ROTOR_POWER = (0.6, 2.0)
"""sqrt(3) times rotor voltage and rotor current, over the rated power."""
RATED_SPEED = (0.8, 0.9999)
"""At rated power, of a wound rotor with its rings shorted, over the synchronous one."""
EXTERNAL_RESISTANCE = 2.0
"""Largest resistance at the slip rings of a running motor, over that of rated torque at standstill."""
DEEP_BAR_RESISTANCE = (1.01, 20.0)
"""Rotor resistance at a great slip over that at a small one."""
DEEP_BAR_LEAKAGE = (0.02, 0.99)
"""The same of its leakage."""
SATURATING_LEAKAGE = (0.0, 0.9)
"""Share of the leakage that is lost at great currents."""
KNEE_CURRENT = (0.5, 20.0)
"""Current at which leakage begins to saturate, over rated power by rated voltage."""
KNEE_SHARPNESS = (1.0, 12.0)
"""How sharp the knee is."""
RATED_CURRENT_A = (0.01, 10e3)
"""Rated power over sqrt(3) times rated voltage [A]."""

EXTRA_LOW_VOLTAGE_V = 100.0
MOST_AT_EXTRA_LOW_VOLTAGE_A = 1500.0
"""Motors of vehicles on batteries have at most so much. A voltage in kV looks like a lower one in V."""
HIGH_VOLTAGE_V = 1000.0
LEAST_AT_HIGH_VOLTAGE_A, USUAL_AT_HIGH_VOLTAGE_A = 0.5, 5.0
"""The smallest motors of over 1 kV have some tens of kW, so draw 5 A and more."""
HIGHEST_USUAL_VOLTAGE_V = 15e3
LEAST_USUAL_POWER_W = 700.0
"""Motors on protection relays have more. The largest low-voltage motors look like less in kW."""

RESISTANCE_PU = (0.0005, 0.5)
LEAKAGE_REACTANCE_PU = (0.005, 1.0)
MAGNETISING_REACTANCE_PU = (0.1, 30.0)
INERTIA_CONSTANT_S = (0.003, 500.0)
GAIN_SPAN = (1e-4, 0.1)
"""From a revenue meter's to that of a transformer for protection of class 10P [share]."""
DELAY_SPAN_S = (1e-7, 500e-6)
"""Up to 9 degrees at 50 Hz [s]."""


@dataclass(frozen=True, slots=True)
class Plausible:
    """The range of one field, and what it comes from.

    Parameters
    ----------
    field : str
        Name of the field in the nameplate or the parameters.
    least : float
        Smallest value, in the field's unit.
    most : float
        Largest value, in the field's unit.
    unit : str
        Unit of the field.
    because : str
        What the range stands for, in words.
    """

    field: str
    least: float
    most: float
    unit: str
    because: str

    def __str__(self) -> str:
        """Return the range in words."""
        return f"{plain(self.least)} to {plain(self.most)} {self.unit} ({self.because})"


def plausible_power(rated_voltage_V: float) -> Plausible:
    """Return the range of the rated power of a motor for this voltage.

    Parameters
    ----------
    rated_voltage_V : float
        Voltage line to line, rms [V].

    Returns
    -------
    Plausible
        Range of `rated_power_W`.
    """
    least_A, most_A = RATED_CURRENT_A
    if rated_voltage_V < EXTRA_LOW_VOLTAGE_V:
        most_A = MOST_AT_EXTRA_LOW_VOLTAGE_A
    if rated_voltage_V > HIGH_VOLTAGE_V:
        least_A = LEAST_AT_HIGH_VOLTAGE_A
    least, most = (sqrt(3.0) * rated_voltage_V * current for current in (least_A, most_A))
    return Plausible(
        "rated_power_W",
        max(RATED_POWER_W[0], least),
        min(RATED_POWER_W[1], most),
        "W",
        f"{plain(least_A, 6)} to {plain(most_A, 6)} A at {plain(rated_voltage_V, 6)} V",
    )


def unusual_rating(nameplate: Nameplate) -> Iterator[tuple[str, str]]:
    """Say what is unusual of a rating, for a motor on a protection relay.

    It need not be wrong. But the power may be in kW, or the voltage have a digit too many.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    tuple of str
        Field of the nameplate, and a sentence.
    """
    power_W, voltage_V = nameplate.rated_power_W, nameplate.rated_voltage_V
    current_A = power_W / (sqrt(3.0) * voltage_V)
    power = f"rated_power_W = {plain(power_W, 6, with_commas=False)}"
    if voltage_V > HIGHEST_USUAL_VOLTAGE_V:
        yield (
            "rated_voltage_V",
            f"rated_voltage_V = {plain(voltage_V, 6, with_commas=False)} is more than motors have "
            f"({plain(HIGHEST_USUAL_VOLTAGE_V)} V at most): is there a digit too many?",
        )
    if voltage_V > HIGH_VOLTAGE_V and current_A < USUAL_AT_HIGH_VOLTAGE_A:
        yield (
            "rated_power_W",
            f"{power} is little for {plain(voltage_V, 6)} V: motors of over {plain(HIGH_VOLTAGE_V)} V have "
            "some tens of kW at least; is it in kW, or rated_voltage_V wrong? Write the power in W",
        )
    elif power_W < LEAST_USUAL_POWER_W:
        yield (
            "rated_power_W",
            f"{power} is little for a motor on a protection relay: is it in kW? Write it in W "
            f"({plain(1e3 * power_W, 6, with_commas=False)} for {plain(power_W, 6)} kW)",
        )


def plausible_parameters(nameplate: Nameplate) -> Iterator[Plausible]:
    """Yield the range of each parameter of a motor with this nameplate.

    The base of the impedance is that of a phase winding: V^2 / P in star, 3 V^2 / P in delta. The base of the
    inertia is the energy that gives an inertia constant H = J w_m^2 / (2 P) at synchronous speed.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    Plausible
        Range of a field of `MachineParameters`.
    """
    base_ohm = nameplate.base_impedance_ohm
    base_H = base_ohm / nameplate.rated_angular_frequency
    of_rating = "per unit of the nameplate"
    for field in ("stator_resistance_ohm", "rotor_resistance_ohm"):
        yield _scaled(field, RESISTANCE_PU, base_ohm, "ohm", of_rating)
    for field in ("stator_leakage_H", "rotor_leakage_H"):
        yield _scaled(field, LEAKAGE_REACTANCE_PU, base_H, "H", of_rating)
    base_of_self_H = base_H / MAGNETISING_OVER_SELF
    yield _scaled("stator_self_inductance_H", MAGNETISING_REACTANCE_PU, base_of_self_H, "H", of_rating)
    base_kgm2 = nameplate.base_inertia_kgm2
    yield _scaled("inertia_kgm2", INERTIA_CONSTANT_S, base_kgm2, "kg m^2", "s of inertia constant")


def plausible_sensors() -> Iterator[Plausible]:
    """Yield the range of each span of a sensor class.

    Yields
    ------
    Plausible
        Range of a field of `SensorClass`.
    """
    for quantity in ("voltage", "current"):
        yield Plausible(f"{quantity}_gain", *GAIN_SPAN, "as a fraction", "0.01 is +-1 %")
        yield Plausible(f"{quantity}_delay_s", *DELAY_SPAN_S, "s", "25e-6 is +-25 us")


def _scaled(field: str, ends: tuple[float, float], base: float, unit: str, of: str) -> Plausible:
    least, most = ends
    return Plausible(field, least * base, most * base, unit, f"{least:g} to {most:g} {of}")
