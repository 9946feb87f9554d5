"""What is estimated: the motor's parameters, shared by all its records, and each start's own quantities.

A fit works on coordinates of order one: the logarithm of a parameter, the load level, T_d in cycles, the
switching flux over the rated one.
"""

from dataclasses import dataclass, replace
from math import log

import numpy as np

from core.commissioning.prior import PARAMETERS, Prior
from core.commissioning.start import Start
from core.machines.base import Array
from core.machines.parameters import MachineParameters
from core.machines.starting import StartCandidates

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
class Point:
    """One machine and its starts.

    Parameters
    ----------
    machine : MachineParameters
        The shared parameters.
    starts : ndarray, shape (records, 4)
        LL, T_d [s] and the flux [V s] of each record.
    """

    machine: MachineParameters
    starts: Array

    def candidates(self, record: int) -> StartCandidates:
        """Return a batch of one for a record.

        Parameters
        ----------
        record : int
            Number of the record, from 0.

        Returns
        -------
        StartCandidates
            The batch.
        """
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
    """The map between points and vectors of order one: five parameters, then four for each record.

    Parameters
    ----------
    prior : Prior
        What is expected of the motor before a record is seen.
    starts : tuple of Start
        The starts.
    """

    prior: Prior
    starts: tuple[Start, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the vector's entries; those of a record carry its number, from 0."""
        own = (f"{name}[{k}]" for k in range(len(self.starts)) for name in OF_A_START)
        return (*PARAMETERS, *own)

    def of_record(self, record: int) -> list[int]:
        """Return the entries that one record's currents depend on.

        Parameters
        ----------
        record : int
            Number of the record, from 0.

        Returns
        -------
        list of int
            Indices of the entries.
        """
        first = len(PARAMETERS) + record * len(OF_A_START)
        return [*range(len(PARAMETERS)), *range(first, first + len(OF_A_START))]

    def vector(self, point: Point) -> Array:
        """Return the coordinates of a point.

        Parameters
        ----------
        point : Point
            The point.

        Returns
        -------
        ndarray, shape (entries,)
            Coordinates.
        """
        shared = [
            log(getattr(point.machine, name) / getattr(self.prior.expected, name)) for name in PARAMETERS
        ]
        own = point.starts / np.array([self._units(start) for start in self.starts])
        return np.concatenate([shared, own.reshape(-1)])

    def point(self, vector: Array) -> Point:
        """Return the point at coordinates.

        Parameters
        ----------
        vector : ndarray, shape (entries,)
            Coordinates.

        Returns
        -------
        Point
            The point.
        """
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
        """Return a batch for one record.

        Parameters
        ----------
        vectors : ndarray, shape (candidates, entries)
            Coordinates of each candidate.
        record : int
            Number of the record, from 0.

        Returns
        -------
        StartCandidates
            The batch.
        """
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
        """Return the bounds of the vector.

        Returns
        -------
        lower : ndarray
            Lower bounds, shape (entries,).
        upper : ndarray
            Upper bounds, shape (entries,).
        """
        lower, upper = [-FARTHEST] * len(PARAMETERS), [FARTHEST] * len(PARAMETERS)
        for start in self.starts:
            earliest, latest = (offset / start.cycle_s for offset in start.offset_range_s)
            lower += [LOWEST_LOAD, earliest, -HIGHEST_FLUX, -HIGHEST_FLUX]
            upper += [HIGHEST_LOAD, latest, HIGHEST_FLUX, HIGHEST_FLUX]
        return np.array(lower), np.array(upper)

    def doubts(self) -> Array:
        """Return the standard deviation of each entry where it is held instead of fitted.

        Returns
        -------
        ndarray, shape (entries,)
            Standard deviations.
        """
        shared = [self.prior.doubt[name] for name in PARAMETERS]
        return np.array(shared + [DOUBT_OF_LOAD, DOUBT_OF_OFFSET, 0.0, 0.0] * len(self.starts))

    @staticmethod
    def _units(start: Start) -> Array:
        return np.array([1.0, start.cycle_s, start.rated_flux_Vs, start.rated_flux_Vs])
