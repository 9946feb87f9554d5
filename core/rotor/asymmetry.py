"""The rotor's asymmetry in one record: where its line stands, how large it is, and how sure that is."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil, floor, hypot, log, pi, sqrt

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.steady_state import ComplexArray
from core.machines.wound_rotor import resistance_ratios
from core.normal_distribution import NINE_IN_TEN, NORMAL_95
from core.rotor.baseband import Baseband
from core.rotor.cage_leakage import LEAST, MOST, USUAL, without_leakage
from core.rotor.rotor_circuit import RotorLines, rotor_lines
from core.rotor.running_point import errors, running_point
from core.rotor.sidebands import Lines, fit_lines, without_lines
from core.rotor.unknown_slip import beyond_a_ripple

LOWEST_RATIO, HIGHEST_RATIO = 0.8, 1.4
"""Where the line may stand, over twice the model's slip: a rotor that is warm, or has broken bars, slips more
than its parameters say."""
FEWEST_TURNS = 1.2
"""Least distance of a line from the fundamental, in cycles of it over the record."""
FEWEST_TURNS_OF_ANY = 2.5
"""The same of a line whose place is unknown."""
POINTS_A_TURN = 4.0
"""Fineness of the search; a line half a step off keeps 97 % of its amplitude."""
FINER = 10
"""Points between two of the search where the line's place tells an unknown slip."""
GUARD_TURNS, REFERENCE_TURNS = 1.0, 24
"""Distance from the search at which noise is taken from, and how far off, in cycles over the record."""
LINE_TURNS = 2.0
"""Half of the width of a line of a record that fades in and out (Hann), in cycles over the record."""
HIGHEST_OVER_SUPPLY = 0.6
"""Highest distance of a line over the supply's frequency; near 1 the means over a cycle leave nothing."""
FALSE_ALARM = 1e-4
"""Chance that noise alone passes for a line."""
MODEL_SHARE = 0.05
"""Standard deviation of what a machine differs by from its linear model (saturation, deep bars), over the
asymmetry."""


@dataclass(frozen=True, slots=True)
class Asymmetry:
    """The rotor's asymmetry in one record.

    Parameters
    ----------
    ratio : float
        Distance of the line over twice the model's slip.
    value : float
        Half the difference of the resistances of the cage's axes, over R_r.
    interval : tuple of float
        Its 95 % interval from noise, parameters and the cage's leakage; it may begin below zero.
    threshold : float
        Value from which on it is neither noise nor a wrongly removed ripple of the speed.
    detection_limit : float
        Value that nine of ten such records show.
    leak : float
        Part of the threshold that comes from the ripple of the speed and the parameters' errors.
    lower, upper : float
        Current at the sidebands over the fundamental, as measured.
    load_torque, inertia_torque : float
        Amplitudes of the load's torque and of that which the ripple of the speed takes, over rated torque.
    load_torque_noise : float
        What noise makes of the load's torque, rms.
    """

    ratio: float
    value: float
    interval: tuple[float, float]
    threshold: float
    detection_limit: float
    leak: float
    lower: float
    upper: float
    load_torque: float
    inertia_torque: float
    load_torque_noise: float

    @property
    def is_detected(self) -> bool:
        """Whether there is an asymmetry at all."""
        return self.value > self.threshold


def measure_asymmetry(
    baseband: Baseband, angle: Array, motor: Motor, at_ends: Sequence[Baseband] = ()
) -> Asymmetry:
    """Find the line of the rotor's asymmetry near twice the model's slip, and what noise is around it.

    Parameters
    ----------
    baseband : Baseband
        The record; it has at least FEWEST_TURNS turns of the angle.
    angle : ndarray, shape (n,)
        Angle of the sidebands [rad].
    motor : Motor
        Nameplate, parameters and their tolerances, and sensors.
    at_ends : sequence of Baseband, optional
        The record at the ends of the 95 % interval of what was taken off it.

    Returns
    -------
    Asymmetry
        The greatest asymmetry of the search where there is one; otherwise that of the strongest lines, which
        tell of the load.
    """
    record = _Record(baseband, angle, motor, tuple(at_ends))
    first, last = record.search
    kappa = np.linspace(first, last, max(2, ceil((last - first) * POINTS_A_TURN) + 1)) / record.turns
    lines = fit_lines(baseband, angle, kappa)
    greatest = int(np.argmax(record.sizes(lines, kappa)))
    if resistance_ratios(motor).are_open:
        found = _measured(record, *_more_finely(record, float(kappa[greatest])))
    else:
        found = _measured(record, lines.at(greatest), kappa[greatest : greatest + 1])
    if found.is_detected:
        return found
    strongest = int(np.argmax(np.abs(lines.upper[:, 1]) + np.abs(lines.lower[:, 1])))
    return _measured(record, lines.at(strongest), kappa[strongest : strongest + 1])


@dataclass(frozen=True, slots=True)
class _Record:
    """A record in which pairs of lines are looked for at multiples of the sidebands' angle."""

    baseband: Baseband
    angle: Array
    motor: Motor
    at_ends: tuple[Baseband, ...]

    @property
    def turns(self) -> float:
        """Cycles of the sidebands' distance over the record."""
        return float(self.angle[-1] - self.angle[0]) / (2.0 * pi)

    @property
    def highest(self) -> float:
        """Farthest lines that the means over a cycle leave, in cycles over the record."""
        return HIGHEST_OVER_SUPPLY * self.baseband.span_s / self.baseband.cycle_s

    @property
    def search(self) -> tuple[float, float]:
        """Distances between which the line is looked for, in cycles over the record."""
        turns, ratios = self.turns, resistance_ratios(self.motor)
        slip = running_point(self.baseband, self.motor).slip(self.motor)
        slips = [1.0, *(running_point(one, self.motor).slip(self.motor) / slip for one in self.at_ends)]
        lowest, highest = LOWEST_RATIO * ratios.least * min(slips), HIGHEST_RATIO * ratios.most * max(slips)
        fewest = FEWEST_TURNS_OF_ANY if ratios.are_open else FEWEST_TURNS
        return max(lowest * turns, fewest), min(highest * turns, self.highest)

    def around(self, kappa: float) -> Array:
        """Return ratios outside the search, a cycle over the record apart, shape (references,).

        Where the slip is unknown the search leaves nothing outside: then they are those beside a line.
        """
        if resistance_ratios(self.motor).are_open:
            first = last = max(kappa * self.turns, FEWEST_TURNS)
            guard = LINE_TURNS
        else:
            (first, last), guard = self.search, GUARD_TURNS
        below = np.arange(floor(first - guard), FEWEST_TURNS, -1.0)
        above = np.arange(last + guard, min(self.highest, last + guard + REFERENCE_TURNS) + 1.0)
        return np.concatenate([below[:REFERENCE_TURNS], above]) / self.turns

    def meaning(
        self, lines: Lines, kappa: Array, motor: Motor | None = None, baseband: Baseband | None = None
    ) -> RotorLines:
        """Return what lines mean, perhaps with another motor's parameters or another fundamental."""
        known, record = motor or self.motor, baseband or self.baseband
        distance = kappa * (2.0 * pi * self.turns / self.baseband.span_s)
        return rotor_lines(lines, distance, running_point(record, known), known)

    def sizes(self, lines: Lines, kappa: Array) -> Array:
        """Return the asymmetry that no swing of the load explains, shape (pairs,)."""
        if not resistance_ratios(self.motor).are_open:
            return np.abs(self.meaning(lines, kappa).asymmetry)
        distance = kappa * (2.0 * pi * self.turns / self.baseband.span_s)
        return beyond_a_ripple(lines, distance, running_point(self.baseband, self.motor), self.motor)

    def errors(self) -> Iterator[tuple[Motor, Baseband, float]]:
        """Yield motor and record with one figure wrong, each with its standard deviations."""
        yield from errors(self.baseband, self.motor)
        for one in self.at_ends:
            yield self.motor, one, sqrt(1.0 / len(self.at_ends)) / NORMAL_95

    def asymmetry(
        self, line: Lines, kappa: Array, motor: Motor | None = None, baseband: Baseband | None = None
    ) -> complex:
        """Return the asymmetry that one pair of lines means."""
        return complex(self.meaning(line, kappa, motor, baseband).asymmetry[0])


def _more_finely(record: _Record, kappa: float) -> tuple[Lines, Array]:
    """Return the pair of lines of the greatest asymmetry near a place, and its own: it tells the slip."""
    near = kappa + np.linspace(-1.0, 1.0, 2 * FINER + 1) / (POINTS_A_TURN * record.turns)
    lines = fit_lines(record.baseband, record.angle, near)
    greatest = int(np.argmax(record.sizes(lines, near)))
    return lines.at(greatest), near[greatest : greatest + 1]


def _measured(record: _Record, line: Lines, kappa: Array) -> Asymmetry:
    baseband, around = record.baseband, record.around(float(kappa[0]))
    left = without_lines(baseband, record.angle, kappa, line)
    beside = record.meaning(fit_lines(left, record.angle, around), around)
    noise = _mean_square(beside.asymmetry)
    first, last = record.search
    found = record.meaning(line, kappa)
    value, size = complex(found.asymmetry[0]), float(record.sizes(line, kappa)[0])
    ripple = _of_the_ripple_alone(record, line, kappa)
    scale, leak = MODEL_SHARE * abs(value), 0.0
    for motor, wrong, deviations in record.errors():
        other = record.asymmetry(line, kappa, motor, wrong)
        scale = hypot(scale, deviations * (abs(other) - abs(value)))
        leak = hypot(leak, deviations * abs(record.asymmetry(ripple, kappa, motor, wrong)))
    by_chance = sqrt(noise * _exceeded_by_chance(around.size, max(1.0, last - first)))
    threshold = hypot(by_chance, NORMAL_95 * leak)
    radial = sqrt((noise + leak**2) / 2.0)
    spread = NORMAL_95 * hypot(radial, scale)
    current = abs(baseband.current.mean())
    # A bad contact of a wound rotor joins no loops, as a broken bar does.
    usual, least, most = (USUAL, LEAST, MOST) if record.motor.wound_rotor is None else (0.0, 0.0, 0.0)
    resistive = partial(
        without_leakage,
        slip_over_resistance=running_point(baseband, record.motor).slip_over_resistance,
        magnetising_inductance_H=record.motor.parameters.magnetising_inductance_H,
    )
    return Asymmetry(
        ratio=float(kappa[0]),
        value=resistive(size, factor=usual),
        interval=(
            resistive(size - spread, factor=most),
            resistive(size + spread, factor=least),
        ),
        threshold=threshold,
        detection_limit=threshold + NINE_IN_TEN * radial,
        leak=NORMAL_95 * leak,
        lower=float(abs(line.lower[0, 1])) / current,
        upper=float(abs(line.upper[0, 1])) / current,
        load_torque=float(abs(found.load_torque[0])),
        inertia_torque=float(abs(found.inertia_torque[0])),
        load_torque_noise=sqrt(_mean_square(beside.load_torque)),
    )


def _of_the_ripple_alone(record: _Record, line: Lines, kappa: Array) -> Lines:
    """Return the lines as they would be without the asymmetry, which is linear in the lower current."""
    unit_A = abs(record.baseband.current.mean())
    without = record.asymmetry(line.with_lower_current(0.0), kappa)
    per_ampere = (record.asymmetry(line.with_lower_current(unit_A), kappa) - without) / unit_A
    return line.with_lower_current(-without / per_ampere)


def _mean_square(x: ComplexArray) -> float:
    """Return the mean square of noise from its median, which single lines of the load do not move."""
    return float(np.median(np.abs(x) ** 2)) / log(2.0)


def _exceeded_by_chance(references: int, chances: float) -> float:
    """Return the ratio to a mean of so many squares that one of so many others exceeds by chance."""
    return references * float((FALSE_ALARM / chances) ** (-1.0 / references) - 1.0)
