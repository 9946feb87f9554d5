"""What is estimated: the motor's parameters, shared by all its records, and each start's own quantities.

A fit works on coordinates of order one: the logarithm of a parameter, the load level, T_d in cycles, the
switching flux over the rated one.
"""

from dataclasses import dataclass, replace
from math import log

import numpy as np

from core.commissioning.start import Start
from core.machines.base import Array
from core.machines.parameters import MachineParameters, Nameplate
from core.machines.starting import StartCandidates

PARAMETERS = (
    "stator_resistance_ohm",
    "rotor_resistance_ohm",
    "stator_leakage_H",
    "stator_self_inductance_H",
    "inertia_kgm2",
)
"""Shared by all records. The rotor's leakage follows the stator's: terminals tell their sum alone."""
LOAD_LEVEL, TIME_OFFSET = "load_level", "time_offset_s"
SWITCHING_FLUX = ("switching_flux_alpha_Vs", "switching_flux_beta_Vs")
OF_A_START = (LOAD_LEVEL, TIME_OFFSET, *SWITCHING_FLUX)
"""Each record's own."""

LOWEST_LOAD, HIGHEST_LOAD = -0.2, 2.0
FARTHEST = log(30.0)
"""How far a parameter may move from its expected value, as a logarithm."""
HIGHEST_FLUX = 2.0
DOUBT_OF_LOAD = 0.5
"""Standard deviation of a load level that no record tells."""
DOUBT_OF_OFFSET = 0.02
"""The same of T_d, in cycles: more than one relay's channels are apart."""


@dataclass(frozen=True, slots=True)
class Prior:
    """What is expected before a record is seen.

    expected: parameters of the file, or typical of the rating.  spread: factor either way that is searched,
    doubt: standard deviation (relative) of a parameter that is taken from it, both by parameter.
    from_file: whether the motor's file gave them.
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
    """The prior of a motor file, with parameters or without.

    Without: per-unit values over rated power, the trend through motors of 0.8, 7.5 and 37 kW. They are only
    the middle of a wide search, and what stands in for a parameter that no record tells.
    """
    if parameters is not None:
        known = dict.fromkeys(PARAMETERS, 2.5) | {"inertia_kgm2": 5.0}
        doubt = dict.fromkeys(PARAMETERS, 0.2) | {"inertia_kgm2": 0.4}
        return Prior(parameters, known, doubt, from_file=True)
    size = nameplate.rated_power_W / 800.0
    # Of a winding: in delta it sees the line voltage and carries a third of the power, as in star.
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


@dataclass(frozen=True, slots=True)
class Point:
    """One machine and its starts: the shared parameters and, for each record, LL, T_d [s] and the flux
    [V s], shape (records, 4)."""

    machine: MachineParameters
    starts: Array

    def candidates(self, record: int) -> StartCandidates:
        """A batch of one for a record."""
        load, offset, *flux = self.starts[record].tolist()
        machine = self.machine
        return StartCandidates(
            np.array([machine.stator_resistance_ohm]),
            np.array([machine.rotor_resistance_ohm]),
            np.array([machine.stator_leakage_H]),
            np.array([machine.rotor_leakage_H]),
            np.array([machine.stator_self_inductance_H]),
            np.array([machine.inertia_kgm2]),
            np.array([load]),
            np.array([offset]),
            np.array([flux]),
        )


@dataclass(frozen=True, slots=True)
class Coordinates:
    """The map between points and vectors of order one: five parameters, then four for each record."""

    prior: Prior
    starts: tuple[Start, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Of the vector's entries; those of a record carry its number, from 0."""
        own = (f"{name}[{k}]" for k in range(len(self.starts)) for name in OF_A_START)
        return (*PARAMETERS, *own)

    def of_record(self, record: int) -> list[int]:
        """Entries that one record's currents depend on."""
        first = len(PARAMETERS) + record * len(OF_A_START)
        return [*range(len(PARAMETERS)), *range(first, first + len(OF_A_START))]

    def vector(self, point: Point) -> Array:
        """Coordinates of a point."""
        shared = [
            log(getattr(point.machine, name) / getattr(self.prior.expected, name)) for name in PARAMETERS
        ]
        own = point.starts / np.array([self._units(start) for start in self.starts])
        return np.concatenate([shared, own.reshape(-1)])

    def point(self, vector: Array) -> Point:
        """The point at coordinates."""
        count = len(PARAMETERS)
        own = vector[count:].reshape(len(self.starts), len(OF_A_START))
        units = np.array([self._units(start) for start in self.starts])
        values = dict(zip(PARAMETERS, np.exp(vector[:count]).tolist(), strict=True))
        expected = self.prior.expected
        machine = replace(
            expected,
            **{name: getattr(expected, name) * factor for name, factor in values.items()},
            rotor_leakage_H=expected.rotor_leakage_H * values["stator_leakage_H"],
        )
        return Point(machine, own * units)

    def candidates(self, vectors: Array, record: int) -> StartCandidates:
        """A batch for one record from vectors (candidates, entries)."""
        expected, count = self.prior.expected, len(PARAMETERS)
        shared = {name: getattr(expected, name) * np.exp(vectors[:, k]) for k, name in enumerate(PARAMETERS)}
        first = count + record * len(OF_A_START)
        own = vectors[:, first : first + len(OF_A_START)] * self._units(self.starts[record])
        return StartCandidates(
            **shared,
            rotor_leakage_H=shared["stator_leakage_H"] * self.prior.leakage_ratio,
            load_level=np.ascontiguousarray(own[:, 0]),
            time_offset_s=np.ascontiguousarray(own[:, 1]),
            switching_flux_Vs=np.ascontiguousarray(own[:, 2:]),
        )

    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the vector."""
        lower, upper = [-FARTHEST] * len(PARAMETERS), [FARTHEST] * len(PARAMETERS)
        for start in self.starts:
            earliest, latest = (offset / start.cycle_s for offset in start.offset_range_s)
            lower += [LOWEST_LOAD, earliest, -HIGHEST_FLUX, -HIGHEST_FLUX]
            upper += [HIGHEST_LOAD, latest, HIGHEST_FLUX, HIGHEST_FLUX]
        return np.array(lower), np.array(upper)

    def doubts(self) -> Array:
        """Standard deviation of each entry where it is held instead of fitted."""
        shared = [self.prior.doubt[name] for name in PARAMETERS]
        return np.array(shared + [DOUBT_OF_LOAD, DOUBT_OF_OFFSET, 0.0, 0.0] * len(self.starts))

    @staticmethod
    def _units(start: Start) -> Array:
        return np.array([1.0, start.cycle_s, start.rated_flux_Vs, start.rated_flux_Vs])
