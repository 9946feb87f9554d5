"""Parameters from a catalogue: efficiency, power factor, currents, torques and speed, but no impedances.

The equivalent circuit has fewer parameters than it has consequences, and a catalogue gives some of these. A
weighted least-squares fit finds the circuit that comes nearest to them and to what is typical of the rating,
after Pedra and Corcoles, whose estimation from manufacturer data minimises the same relative errors. Each
figure weighs by what IEC 60034-1 (table of tolerances) lets one motor differ from its catalogue. What the
catalogue leaves open keeps the width of typical parameters, so intervals are as wide as they have to be.

With the rotor locked, the cage's current crowds to the top of its bars and the leakage paths saturate: R_r'
is then k_R times, the leakage k_X times that of a running motor. Both are unknowns, too. Losses beside those
of the windings are a share of all losses, half of them in the core, half at the shaft.

References
----------
J. Pedra, F. Corcoles: Estimation of induction motor double-cage model parameters from manufacturer data, IEEE
Transactions on Energy Conversion 19 (2004) 310-317. K. Lee, S. Frank, P. K. Sen, L. G. Polese, M. Alahmad, C.
Waters: Estimation of induction motor equivalent circuit parameters from nameplate data, North American Power
Symposium 2012. IEC 60034-1, clause 12.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import exp, hypot, log, pi, sqrt

import numpy as np

from core.commissioning.catalogue_data import FIGURES, CatalogueData, check_figures
from core.commissioning.data_sheet import DATA_SHEET, INERTIA_TOLERANCE
from core.commissioning.errors import CommissioningError
from core.commissioning.rated_performance import (
    OTHER,
    R_R,
    R_S,
    SATURATION,
    SKIN,
    SLIP,
    SLIPS,
    X_L,
    X_M,
    performance,
)
from core.machines.base import Array
from core.machines.parameters import MachineParameters, Nameplate, WoundRotor
from core.machines.plausibility import plausible_parameters
from core.machines.typical import typical_parameters
from core.normal_distribution import NORMAL_95
from core.quantity_text import plain

LEAST_HALF_WIDTH = 0.05
"""Of an interval: no catalogue is of one motor alone."""
SPLIT = 0.15
"""Standard deviation of the logarithm of either leakage beside their mean: no catalogue tells the ratio."""
ROUNDING_RPM = 0.5

LARGEST_RATED_SLIP = 0.5
LEAST_RATIO = 1e-6
"""A fit on its way may try a circuit without output, whose torques have no logarithm."""
FARTHEST = 6.0
"""Standard deviations from what is typical of the rating, beyond which no circuit is looked for."""

PRIOR_OF_OTHERS = {
    SKIN: (log(1.6), 0.45),
    SATURATION: (log(0.85), 0.15),
    OTHER: (log(0.45), 0.3),
}
"""Logarithms with standard deviations: k_R, k_X, and the share of the losses that are not of the windings."""
SKIN_OF_A_WINDING = (log(1.05), 0.05)
"""The same of k_R where the rotor has coils of many turns: their current crowds little."""


@dataclass(frozen=True, slots=True)
class Compared:
    """A figure of the catalogue beside that of the circuit found.

    Parameters
    ----------
    name : str
        Its name.
    given : float or None
        What the catalogue says; None where it says nothing.
    computed : float
        What the circuit gives.
    deviations : float or None
        Computed less given, in standard deviations of what the standard allows, and of what the circuit
        does not tell.
    """

    name: str
    given: float | None
    computed: float
    deviations: float | None


@dataclass(frozen=True, slots=True)
class CircuitFound:
    """The equivalent circuit that comes nearest to a catalogue.

    Parameters
    ----------
    parameters : MachineParameters
        Parameters of a winding.
    intervals : dict of str to tuple of float
        95 % intervals by parameter.
    compared : tuple of Compared
        All figures, given or not, beside those of the circuit.
    """

    parameters: MachineParameters
    intervals: dict[str, tuple[float, float]]
    compared: tuple[Compared, ...]


def circuit_from_catalogue(
    data: CatalogueData,
    nameplate: Nameplate,
    wound_rotor: WoundRotor | None = None,
    *,
    inertia_kgm2: float | None = None,
) -> CircuitFound:
    """Find the equivalent circuit that comes nearest to a catalogue.

    Parameters
    ----------
    data : CatalogueData
        The figures.
    nameplate : Nameplate
        Rated values of the motor.
    wound_rotor : WoundRotor or None, optional
        Its rotor's winding, whose plate tells the resistance; None of a cage.
    inertia_kgm2 : float or None, optional
        Inertia of motor and load; typical of the rating if None [kg m^2].

    Returns
    -------
    CircuitFound
        Parameters, intervals and residuals.

    Raises
    ------
    CommissioningError
        If a figure is impossible, or there are too few.
    """
    from scipy.optimize import least_squares  # its import takes longer than the fit

    check_figures(data, nameplate)
    middle, deviation = _prior(nameplate, wound_rotor)
    figures = _Figures(data, nameplate)

    def residuals(x: Array) -> Array:
        return np.concatenate([(x - middle) / deviation, figures.residuals(x)])

    low, high = middle - FARTHEST * deviation, middle + FARTHEST * deviation
    high[SLIP] = log(LARGEST_RATED_SLIP)
    fit = least_squares(
        residuals, middle, bounds=(low, high), x_scale=deviation, xtol=1e-12, ftol=1e-12, gtol=1e-12
    )
    slopes = np.asarray(fit.jac, dtype=np.float64)
    spread = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    base_ohm, w = nameplate.base_impedance_ohm, nameplate.rated_angular_frequency
    typical = typical_parameters(nameplate, wound_rotor)
    R_s, R_r, X_l, X_m = np.exp(fit.x[:4]).tolist()
    parameters = MachineParameters.from_magnetising_inductance(
        stator_resistance_ohm=R_s * base_ohm,
        rotor_resistance_ohm=R_r * base_ohm,
        stator_leakage_H=X_l * base_ohm / w,
        rotor_leakage_H=X_l * base_ohm / w,
        magnetising_inductance_H=X_m * base_ohm / w,
        inertia_kgm2=typical.parameters.inertia_kgm2 if inertia_kgm2 is None else inertia_kgm2,
    )
    compared = figures.compared(fit.x)
    _check_circuit(parameters, compared, nameplate)
    leakage = hypot(float(spread[X_L]), SPLIT)
    widths = {
        "stator_resistance_ohm": float(spread[R_S]),
        "rotor_resistance_ohm": float(spread[R_R]),
        "stator_leakage_H": leakage,
        "rotor_leakage_H": leakage,
        "stator_self_inductance_H": float(spread[X_M]),
    }
    intervals = {}
    for name, one in widths.items():
        value = getattr(parameters, name)
        factor = exp(max(NORMAL_95 * one, LEAST_HALF_WIDTH))
        intervals[name] = (value / factor, value * factor)
    if inertia_kgm2 is None:
        intervals["inertia_kgm2"] = typical.intervals["inertia_kgm2"]
    else:
        intervals["inertia_kgm2"] = (
            inertia_kgm2 * (1 - INERTIA_TOLERANCE),
            inertia_kgm2 * (1 + INERTIA_TOLERANCE),
        )
    return CircuitFound(parameters, intervals, compared)


def figures_of(
    machine: MachineParameters,
    data: CatalogueData,
    nameplate: Nameplate,
    wound_rotor: WoundRotor | None = None,
) -> tuple[Compared, ...]:
    """Hold a circuit that is known against the figures of a catalogue.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of a winding.
    data : CatalogueData
        The figures; none need be given.
    nameplate : Nameplate
        Rated values of the motor.
    wound_rotor : WoundRotor or None, optional
        Its rotor's winding; None of a cage.

    Returns
    -------
    tuple of Compared
        All figures of the circuit at rated output, beside those given.

    Raises
    ------
    CommissioningError
        If a figure is impossible, or the circuit cannot bear its rated torque.
    """
    from scipy.optimize import brentq

    check_figures(data, nameplate, fewest=0)
    base_ohm, w = nameplate.base_impedance_ohm, nameplate.rated_angular_frequency
    x, deviation = _prior(nameplate, wound_rotor)
    x[[R_S, R_R, X_M]] = np.log(
        [
            machine.stator_resistance_ohm / base_ohm,
            machine.rotor_resistance_ohm / base_ohm,
            w * machine.magnetising_inductance_H / base_ohm,
        ]
    )
    x[X_L] = log(w * (machine.stator_leakage_H + machine.rotor_leakage_H) / 2.0 / base_ohm)

    def output(slip: float) -> float:
        x[SLIP] = log(slip)
        return performance(x)["output"] - 1.0

    slips = [slip for slip in SLIPS.tolist() if slip < LARGEST_RATED_SLIP and output(slip) >= 0.0]
    if not slips:
        raise CommissioningError(
            DATA_SHEET,
            "impedances",
            expected="a motor that bears its rated torque",
            found="one that does not: check unit, base and which values these are",
        )
    x[SLIP] = log(brentq(output, 1e-6, slips[0]))
    return _Figures(data, nameplate).compared(
        x, unknown=[(place, float(deviation[place])) for place in (SKIN, SATURATION, OTHER)]
    )


class _Figures:
    """The figures of a catalogue, with what one motor may differ from them."""

    def __init__(self, data: CatalogueData, nameplate: Nameplate) -> None:
        self._given = data.given
        synchronous = 60.0 * nameplate.rated_frequency_Hz / nameplate.pole_pairs
        self._scale = {
            "rated_current_A": nameplate.rated_power_W / (sqrt(3.0) * nameplate.rated_voltage_V),
            "rated_speed_rpm": synchronous,
            "stator_resistance_ohm": nameplate.base_impedance_ohm,
        }
        slip_rpm = synchronous - self._given.get("rated_speed_rpm", 0.0)
        self._compare: dict[str, tuple[Callable[[float], float], float]] = {
            "efficiency": (lambda one: -log(max(1.0 - one, 1e-4)), 0.08),
            "power_factor": (lambda one: one, 0.015),
            "rated_current_A": (_logarithm, 0.03),
            "rated_speed_rpm": (lambda one: -log(max(1.0 - one, 1e-5)), hypot(0.1, ROUNDING_RPM / slip_rpm)),
            "locked_rotor_current": (_logarithm, 0.08),
            "locked_rotor_torque": (_logarithm, 0.12),
            "breakdown_torque": (_logarithm, 0.08),
            "stator_resistance_ohm": (_logarithm, 0.05),
        }

    def residuals(self, x: Array) -> Array:
        """Return rated output, then each figure given, over their standard deviations."""
        computed = performance(x)
        rest = [self._deviations(name, computed[name]) for name in self._given]
        return np.array([(computed["output"] - 1.0) / 0.003, *rest])

    def compared(self, x: Array, *, unknown: Sequence[tuple[int, float]] = ()) -> tuple[Compared, ...]:
        """Return all figures beside those of a circuit, in their own units.

        unknown: places of what is not known of the circuit but typical of the rating, with the standard
        deviation of its logarithm.
        """
        computed = performance(x)
        others = []
        for place, deviation in unknown:
            other = x.copy()
            other[place] += deviation
            others.append(performance(other))

        def spread(name: str) -> float:
            """Return the standard deviation of a figure over that which the standard allows."""
            here = self._deviations(name, computed[name])
            return hypot(1.0, *(self._deviations(name, other[name]) - here for other in others))

        return tuple(
            Compared(
                name,
                self._given.get(name),
                computed[name] * self._scale.get(name, 1.0),
                self._deviations(name, computed[name]) / spread(name) if name in self._given else None,
            )
            for name in self._compare
        )

    def _deviations(self, name: str, computed: float) -> float:
        measure, deviation = self._compare[name]
        return (measure(computed) - measure(self._given[name] / self._scale.get(name, 1.0))) / deviation


def _check_circuit(machine: MachineParameters, compared: tuple[Compared, ...], nameplate: Nameplate) -> None:
    """Raise CommissioningError, which names the figure that fits worst, for a circuit that no motor has."""
    worst = max(compared, key=lambda one: abs(one.deviations or 0.0))
    for one in plausible_parameters(nameplate):
        value = getattr(machine, one.field)
        if not one.least <= value <= one.most:
            raise CommissioningError(
                DATA_SHEET,
                FIGURES[worst.name],
                expected="figures that a motor of the rating can have together",
                found=f"a circuit whose {one.field} is {plain(value)}, not {one}; this figure fits worst",
            )


def _logarithm(value: float) -> float:
    return log(max(value, LEAST_RATIO))


def _prior(nameplate: Nameplate, wound_rotor: WoundRotor | None) -> tuple[Array, Array]:
    """Return the logarithms that are typical of the rating, and their standard deviations."""
    found, base_ohm = typical_parameters(nameplate, wound_rotor), nameplate.base_impedance_ohm
    typical = found.parameters
    w = 2.0 * pi * nameplate.rated_frequency_Hz
    R_r = typical.rotor_resistance_ohm / base_ohm
    others = PRIOR_OF_OTHERS if wound_rotor is None else PRIOR_OF_OTHERS | {SKIN: SKIN_OF_A_WINDING}
    middle = [
        log(typical.stator_resistance_ohm / base_ohm),
        log(R_r),
        log(w * typical.stator_leakage_H / base_ohm),
        log(w * typical.magnetising_inductance_H / base_ohm),
        *(others[k][0] for k in (SKIN, SATURATION, OTHER)),
        log(R_r),
    ]
    names = ("stator_resistance_ohm", "rotor_resistance_ohm", "stator_leakage_H", "stator_self_inductance_H")
    deviation = [log(found.intervals[name][1] / getattr(typical, name)) / 2.0 for name in names]
    deviation += [others[k][1] for k in (SKIN, SATURATION, OTHER)]
    return np.array(middle), np.array([*deviation, 1.0])
