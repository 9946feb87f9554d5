"""What is expected of a motor before its start was recorded."""

from dataclasses import dataclass

from core.machines.parameters import MachineParameters, Nameplate, WoundRotor
from core.machines.typical import typical_parameters

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


def prior_of(
    nameplate: Nameplate, parameters: MachineParameters | None, wound_rotor: WoundRotor | None = None
) -> Prior:
    """Return what is expected of a motor, with known parameters or without.

    Without them they are typical of the rating: the middle of a wide search, and what stands in for a
    parameter that no record tells.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    parameters : MachineParameters or None
        Parameters of the motor file, None where it has none.
    wound_rotor : WoundRotor or None, optional
        The rotor's winding; None of a cage.

    Returns
    -------
    Prior
        What is expected.
    """
    if parameters is not None:
        known = dict.fromkeys(PARAMETERS, 2.5) | {"inertia_kgm2": 5.0}
        doubt = dict.fromkeys(PARAMETERS, 0.2) | {"inertia_kgm2": 0.4}
        return Prior(parameters, known, doubt, from_file=True)
    guessed = dict.fromkeys(PARAMETERS, 4.0) | {"inertia_kgm2": 15.0}
    doubt = dict.fromkeys(PARAMETERS, 0.5) | {"inertia_kgm2": 1.0}
    return Prior(typical_parameters(nameplate, wound_rotor).parameters, guessed, doubt, from_file=False)
