"""What is estimated: the motor's parameters, shared by all its records, and each start's own quantities.

A fit works on coordinates of order one: the logarithm of a parameter, the load level, T_d in cycles, the
switching flux over the rated one. Of a motor that changes from a start to running, there are five more: by
how much resistance and leakage of the rotor do, and share, knee and sharpness of the leakage that saturates.
Where the load changes during a start, each start has three more: by how much, from when on and how long.
"""

from dataclasses import dataclass, replace
from math import exp, log

import numpy as np

from core.commissioning.prior import PARAMETERS, Prior
from core.commissioning.start import Start
from core.machines.base import Array
from core.machines.deep_bar_starts import DeepBarCandidates
from core.machines.deep_bars import USUAL_SHARPNESS, DeepBars, LeakageSaturation
from core.machines.parameters import MachineParameters
from core.machines.starting import StartCandidates

LOAD_LEVEL, TIME_OFFSET = "load_level", "time_offset_s"
SWITCHING_FLUX = ("switching_flux_alpha_Vs", "switching_flux_beta_Vs")
OF_A_START = (LOAD_LEVEL, TIME_OFFSET, *SWITCHING_FLUX)
"""Each record's own."""
LOAD_CHANGE = "load_change"
OF_A_LOAD_CHANGE = (LOAD_CHANGE, "change_begins_s", "change_lasts_s")
"""Each record's own, beside those, where the load changes during the start."""
LARGEST_LOAD_CHANGE = 2.0
SHORTEST_CHANGE_CYCLES = 0.5
"""A load that changes faster is a step: the speed, which follows the integral, does not show it."""
KNEE_SHARPNESS = "knee_sharpness"
OF_A_CHANGE = ("resistance_ratio", "leakage_share", "saturating_share", "knee_current_A", KNEE_SHARPNESS)
"""Of a motor that changes from a start to running."""
LOGARITHMS = ("resistance_ratio", "knee_current_A", KNEE_SHARPNESS)
"""Those whose coordinate is the logarithm."""
USUAL_CHANGE = (log(1.6), 0.8, 0.15, 0.0, log(USUAL_SHARPNESS))
"""What they are taken for where no record tells them."""
LOWEST_CHANGE = (log(1.03), 0.1, 0.0, -1.0, log(1.2))
HIGHEST_CHANGE = (log(12.0), 0.97, 0.8, log(4.0), log(8.0))
DOUBT_OF_CHANGE = (0.3, 0.15, 0.1, 0.4, 0.4)
"""Standard deviations of what is taken for them."""
KNEE_OVER_RATED = 2.0
"""Usual current at which leakage begins to saturate, over the rated one."""

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
    starts : ndarray, shape (records, 4) or (records, 7)
        LL, T_d [s] and the flux [V s] of each record; with how its load changes, by how much, from when on
        and how long [s].
    change : tuple of DeepBars and LeakageSaturation, or None, optional
        How it changes from a start to running.
    """

    machine: MachineParameters
    starts: Array
    change: tuple[DeepBars, LeakageSaturation] | None = None

    def candidates(self, record: int) -> StartCandidates:
        """Return a batch of one for a record, of the machine as it runs.

        Parameters
        ----------
        record : int
            Number of the record, from 0.

        Returns
        -------
        StartCandidates
            The batch.
        """
        load, offset, *flux = self.starts[record, : len(OF_A_START)].tolist()
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
    """The map between points and vectors of order one: the motor's parameters, then four for each record.

    Parameters
    ----------
    prior : Prior
        What is expected of the motor before a record is seen.
    starts : tuple of Start
        The starts.
    changes : bool, default False
        Whether the motor changes from a start to running.
    load_changes : bool, default False
        Whether the load changes during the starts.
    """

    prior: Prior
    starts: tuple[Start, ...]
    changes: bool = False
    load_changes: bool = False

    @property
    def shared(self) -> tuple[str, ...]:
        """Names of the entries that all records share."""
        return (*PARAMETERS, *OF_A_CHANGE) if self.changes else PARAMETERS

    @property
    def own(self) -> tuple[str, ...]:
        """Names of the entries that each record has."""
        return (*OF_A_START, *OF_A_LOAD_CHANGE) if self.load_changes else OF_A_START

    @property
    def usual_knee_A(self) -> float:
        """Current at which the leakage of such a motor usually begins to saturate, rms of a winding [A]."""
        return KNEE_OVER_RATED * self.starts[0].rated_winding_current_A

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the vector's entries; those of a record carry its number, from 0."""
        own = (f"{name}[{k}]" for k in range(len(self.starts)) for name in self.own)
        return (*self.shared, *own)

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
        first = self.first_of(record)
        return [*range(len(self.shared)), *range(first, first + len(self.own))]

    def first_of(self, record: int) -> int:
        """Return the index of a record's first own entry.

        Parameters
        ----------
        record : int
            Number of the record, from 0.

        Returns
        -------
        int
            Its index.
        """
        return len(self.shared) + record * len(self.own)

    def changing(self, vector: Array, change: Array) -> Array:
        """Return the vector of a motor that changes, from that of one which does not.

        Parameters
        ----------
        vector : ndarray
            Coordinates without a change.
        change : ndarray, shape (5,)
            Coordinates of the change.

        Returns
        -------
        ndarray
            Coordinates with both.
        """
        count = len(PARAMETERS)
        return np.concatenate([vector[:count], change, vector[count:]])

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
        if point.change is not None:
            bars, saturation = point.change
            knee = log(saturation.knee_current_A / self.usual_knee_A)
            shared += [log(bars.resistance_ratio), bars.leakage_share]
            shared += [saturation.share, knee, log(saturation.knee_sharpness)]
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
        own = vector[len(self.shared) :].reshape(len(self.starts), len(self.own))
        units = np.array([self._units(start) for start in self.starts])
        values = dict(zip(PARAMETERS, np.exp(vector[:count]).tolist(), strict=True))
        expected = self.prior.expected
        machine = replace(
            expected,
            **{name: getattr(expected, name) * factor for name, factor in values.items()},
            rotor_leakage_H=expected.rotor_leakage_H * values["stator_leakage_H"],
        )
        change = None
        if self.changes:
            ratio, share, saturating, knee, sharpness = vector[count : len(self.shared)].tolist()
            saturation = LeakageSaturation(saturating, self.usual_knee_A * exp(knee), exp(sharpness))
            change = DeepBars(exp(ratio), share), saturation
        return Point(machine, own * units, change)

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
        first = self.first_of(record)
        own = vectors[:, first : first + len(self.own)] * self._units(self.starts[record])
        shared["rotor_leakage_H"] = shared["stator_leakage_H"] * self.prior.leakage_ratio
        shared["load_level"] = np.ascontiguousarray(own[:, 0])
        shared["time_offset_s"] = np.ascontiguousarray(own[:, 1])
        shared["switching_flux_Vs"] = np.ascontiguousarray(own[:, 2:4])
        if self.load_changes:
            shared |= zip(OF_A_LOAD_CHANGE, own[:, 4:].T, strict=True)
        if not self.changes:
            return self._unchanging(shared) if self.load_changes else StartCandidates(**shared)
        ratio, share, saturating, knee, sharpness = vectors[:, count : len(self.shared)].T
        return DeepBarCandidates(
            **shared,
            resistance_ratio=np.exp(ratio),
            leakage_share=share,
            saturating_share=saturating,
            knee_current_A=self.usual_knee_A * np.exp(knee),
            knee_sharpness=np.exp(sharpness),
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
        if self.changes:
            lower, upper = [*lower, *LOWEST_CHANGE], [*upper, *HIGHEST_CHANGE]
        for start in self.starts:
            earliest, latest = (offset / start.cycle_s for offset in start.offset_range_s)
            lower += [LOWEST_LOAD, earliest, -HIGHEST_FLUX, -HIGHEST_FLUX]
            upper += [HIGHEST_LOAD, latest, HIGHEST_FLUX, HIGHEST_FLUX]
            if self.load_changes:
                cycles = start.compared_cycles
                lower += [-LARGEST_LOAD_CHANGE, 0.0, SHORTEST_CHANGE_CYCLES]
                upper += [LARGEST_LOAD_CHANGE, cycles, max(cycles, 2.0 * SHORTEST_CHANGE_CYCLES)]
        return np.array(lower), np.array(upper)

    def doubts(self) -> Array:
        """Return the standard deviation of each entry where it is held instead of fitted.

        Returns
        -------
        ndarray, shape (entries,)
            Standard deviations.
        """
        shared = [self.prior.doubt[name] for name in PARAMETERS]
        if self.changes:
            shared += DOUBT_OF_CHANGE
        own = [DOUBT_OF_LOAD, DOUBT_OF_OFFSET, 0.0, 0.0]
        return np.array(shared + [*own, *([0.0] * (len(self.own) - len(own)))] * len(self.starts))

    def _units(self, start: Start) -> Array:
        own = [1.0, start.cycle_s, start.rated_flux_Vs, start.rated_flux_Vs]
        return np.array([*own, 1.0, start.cycle_s, start.cycle_s] if self.load_changes else own)

    def _unchanging(self, shared: dict[str, Array]) -> DeepBarCandidates:
        """Return machines of one rotor loop and constant leakage in the form of those that change."""
        one = np.ones(1)
        return DeepBarCandidates(
            **shared,
            resistance_ratio=one,
            leakage_share=one,
            saturating_share=np.zeros(1),
            knee_current_A=self.usual_knee_A * one,
            knee_sharpness=USUAL_SHARPNESS * one,
        )
