"""What is expected of a motor before its start was recorded."""

from dataclasses import dataclass

from core.machines.parameters import MachineParameters, Nameplate

PARAMETERS = (
    "stator_resistance_ohm",
    "rotor_resistance_ohm",
    "stator_leakage_H",
    "stator_self_inductance_H",
    "inertia_kgm2",
)
"""Shared by all records. The rotor's leakage follows the stator's: terminals tell their sum alone."""


@dataclass(frozen=True, slots=True)
class Prior:
    """What is expected before a record is seen.

    Parameters
    ----------
    expected : MachineParameters
        Parameters of the file, or typical of the rating.
    spread : dict of str to float
        Factor either way that is searched, by parameter.
    doubt : dict of str to float
        Relative standard deviation of a parameter that is taken from it, by parameter.
    from_file : bool
        Whether the motor's file gave the parameters.
    """

    expected: MachineParameters
    spread: dict[str, float]
    doubt: dict[str, float]
    from_file: bool

    @property
    def leakage_ratio(self) -> float:
        """Rotor over stator leakage inductance, which no record can tell."""
        return self.expected.rotor_leakage_H / self.expected.stator_leakage_H


def prior_of(nameplate: Nameplate, parameters: MachineParameters | None) -> Prior:
    """Return what is expected of a motor, with known parameters or without.

    Without them the per-unit values follow rated power, the trend through motors of 0.8, 7.5 and 37 kW. They
    are only the middle of a wide search, and what stands in for a parameter that no record tells.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    parameters : MachineParameters or None
        Parameters of the motor file, None where it has none.

    Returns
    -------
    Prior
        What is expected.
    """
    if parameters is not None:
        known = dict.fromkeys(PARAMETERS, 2.5) | {"inertia_kgm2": 5.0}
        doubt = dict.fromkeys(PARAMETERS, 0.2) | {"inertia_kgm2": 0.4}
        return Prior(parameters, known, doubt, from_file=True)
    size = nameplate.rated_power_W / 800.0
    # The impedance is that of a winding, which in delta sees the line voltage. It carries a third of the
    # power in star and in delta.
    impedance = nameplate.rated_voltage_V**2 / nameplate.rated_power_W
    if nameplate.connection.value == "delta":
        impedance *= 3.0
    w_b = nameplate.rated_angular_frequency
    resistance = 0.045 * size**-0.25 * impedance
    leakage = 0.05 * impedance / w_b
    expected = MachineParameters(
        stator_resistance_ohm=resistance,
        rotor_resistance_ohm=resistance,
        stator_leakage_H=leakage,
        rotor_leakage_H=leakage,
        stator_self_inductance_H=1.2 * size**0.13 * impedance / w_b / 1.5,
        inertia_kgm2=0.6 * nameplate.rated_power_W / (w_b / nameplate.pole_pairs) ** 2,
    )
    guessed = dict.fromkeys(PARAMETERS, 4.0) | {"inertia_kgm2": 15.0}
    doubt = dict.fromkeys(PARAMETERS, 0.5) | {"inertia_kgm2": 1.0}
    return Prior(expected, guessed, doubt, from_file=False)
