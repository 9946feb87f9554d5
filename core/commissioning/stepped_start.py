"""A wound rotor's start by steps of resistance: what each step has, the inertia and the load.

From the terminals follow the torque T_e and lambda = s w_s / R, whatever R is (`core.machines.air_gap`). The
speed is that of the equation of motion, so with p pole pairs and the steps' resistances R_k

    w_s = (p / J) integral T_e dt - (p / J) T_L integral h dt + R_k lambda        h = 1, or (w / w_s)^2

which is linear in p / J, p T_L / J and all R_k: one least-squares fit over the start. The last step is that
of the running motor; its R is the motor file's where that knows it, for an error of a thousandth of the speed
would be a tenth of it. Just after a step the rotor's flux has not settled, so some cycles are left out.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.commissioning.start import Start
from core.machines.air_gap import UNSETTLED_CYCLES, AirGap
from core.machines.base import Array
from core.machines.candidates import LoadLaw
from core.machines.parameters import Motor
from core.machines.wound_rotor import resistance_ratios, while_running
from core.normal_distribution import NORMAL_95

JUMP = 0.15
"""Growth of the logarithm of lambda within five cycles that only a step of the resistance makes: a motor that
runs up has less and less."""
BESIDE_CYCLES = 2.5
APART_CYCLES = 16.0
"""Cycles about a step in which there is no other: flux and speed swing once after it."""
LEFT_OUT_CYCLES = 6.0
"""Cycles about a step that are not fitted."""
SAME_RESISTANCE = 0.9
"""Share of a resistance that is left from which on nothing was taken out."""
FEWEST_CYCLES = 8.0
"""Of a step that is fitted."""
LAWS = (LoadLaw.CONSTANT, LoadLaw.QUADRATIC)
ROUNDS = 4
"""Fits of a load that depends on the speed that the fit finds."""
UNIFORM = 1.0 / sqrt(3.0)
LEAST_LAMBDA = 1e-9
MODEL_SHARE = 0.002
"""Standard deviation of the speed that the fit finds, over the synchronous one."""


@dataclass(frozen=True, slots=True)
class SteppedStart:
    """What a start by steps of resistance tells.

    Parameters
    ----------
    begins_s : tuple of float
        When each step begins, after the switching on [s].
    rotor_circuit_ohm : ndarray, shape (steps,)
        R of each step, referred to the stator [ohm].
    slips : ndarray, shape (steps,)
        Largest slip of each step that is fitted.
    inertia_kgm2 : float
        J of motor and load [kg m^2].
    load_torque_Nm : float
        T_L at synchronous speed [N m].
    load_law : LoadLaw
        How it grows with the speed.
    speed : ndarray, shape (n,)
        Electrical speed at the samples of the air gap [rad/s].
    residual : float
        What the fit leaves, rms, over the synchronous speed.
    """

    begins_s: tuple[float, ...]
    rotor_circuit_ohm: Array
    slips: Array
    inertia_kgm2: float
    load_torque_Nm: float
    load_law: LoadLaw
    speed: Array
    residual: float

    @property
    def figures(self) -> Array:
        """Inertia, load torque and resistances, in this order."""
        return np.array([self.inertia_kgm2, self.load_torque_Nm, *self.rotor_circuit_ohm])


def stepped_start(gap: AirGap, motor: Motor) -> SteppedStart | None:
    """Fit a start by steps of resistance.

    Parameters
    ----------
    gap : AirGap
        Torque and slip of the start by the motor's parameters.
    motor : Motor
        The motor; of its parameters R_s and the inductances count.

    Returns
    -------
    SteppedStart or None
        What it tells; None where the start has no steps.
    """
    w_s, p = 2.0 * pi * gap.frequency_hz, motor.nameplate.pole_pairs
    running = while_running(motor)
    known_ohm = None if resistance_ratios(running).are_open else running.parameters.rotor_resistance_ohm
    lam = gap.slip * w_s / motor.parameters.rotor_resistance_ohm
    torque = np.cumsum(gap.torque_Nm) / gap.sample_rate_hz
    steps = _steps(lam, gap.cycle)
    while steps:
        sections = list(_sections(steps, lam.size, gap.cycle))
        if len(sections) < len(steps) + 1:
            return None
        course = _Course(lam, torque, w_s, gap.sample_rate_hz, sections, known_ohm)
        residual, law, unknowns, speed = min(map(course.fitted, LAWS), key=lambda fit: fit[0])
        same = np.flatnonzero(unknowns[3:] > SAME_RESISTANCE * unknowns[2:-1])
        if not same.size:
            break
        del steps[int(same[0])]  # the flux swung, and the resistance stayed
    else:
        return None
    inertia = p / unknowns[0]
    return SteppedStart(
        begins_s=tuple(one / gap.sample_rate_hz for one in (0, *steps)),
        rotor_circuit_ohm=unknowns[2:],
        slips=np.array([float(lam[one].max()) for one in sections]) * unknowns[2:] / w_s,
        inertia_kgm2=inertia,
        load_torque_Nm=unknowns[1] * inertia / p,
        load_law=law,
        speed=speed,
        residual=residual / w_s,
    )


def half_intervals(start: Start, motor: Motor, found: SteppedStart) -> Array:
    """Return how far the figures of a start may be off: parameters and channels, each by its tolerance.

    Parameters
    ----------
    start : Start
        The start.
    motor : Motor
        The motor, with the tolerances of its parameters and the class of its sensors.
    found : SteppedStart
        What was found.

    Returns
    -------
    ndarray, shape (2 + steps,)
        Half of the 95 % interval of each of `figures`.
    """
    squares = np.zeros(found.figures.size)
    for other, wrong in _errors(start, motor):
        again = stepped_start(other.air_gap(wrong.parameters), wrong)
        if again is not None and again.figures.size == squares.size:
            squares += (UNIFORM * (again.figures - found.figures)) ** 2
    of_model = MODEL_SHARE * np.array([1.0, 1.0, *(1.0 / found.slips)])
    return np.asarray(NORMAL_95 * np.hypot(np.sqrt(squares), of_model * found.figures))


def _errors(start: Start, motor: Motor) -> Iterator[tuple[Start, Motor]]:
    """Yield start and motor with one figure wrong by its tolerance."""
    machine, tolerances, sensors = motor.parameters, motor.tolerances, motor.sensors
    for names in (
        ("stator_resistance_ohm",),
        ("stator_leakage_H", "rotor_leakage_H"),
        ("stator_self_inductance_H",),
        ("rotor_resistance_ohm",),
    ):
        factor = 1.0 + min(getattr(tolerances, names[0]), 1.0)
        wrong = replace(machine, **{name: factor * getattr(machine, name) for name in names})
        yield start, replace(motor, parameters=wrong)
    yield replace(start, current_ab=start.current_ab * (1.0 + sensors.current_gain)), motor
    yield replace(start, voltage_ab=start.voltage_ab * (1.0 + sensors.voltage_gain)), motor


def _steps(lam: Array, cycle: int) -> list[int]:
    """Return the samples at which lambda jumps up."""
    beside, apart = round(BESIDE_CYCLES * cycle), round(APART_CYCLES * cycle)
    logs = np.log(np.maximum(lam, LEAST_LAMBDA))
    rise = np.zeros(lam.size)
    rise[beside:-beside] = logs[2 * beside :] - logs[: -2 * beside]
    rise[: UNSETTLED_CYCLES * cycle + beside] = 0.0
    found = []
    while rise.max(initial=0.0) > JUMP:
        at = int(np.argmax(rise))
        # The jump is within a few cycles behind the first of its largest rises, where lambda grows fastest.
        near = slice(max(0, at - beside), at + 2 * beside)
        found.append(near.start + int(np.argmax(np.gradient(logs[near]))))
        rise[max(0, at - apart) : at + apart] = 0.0
    return sorted(found)


def _sections(steps: list[int], samples: int, cycle: int) -> Iterator[NDArray[np.int64]]:
    """Yield the samples of each step that are fitted, two a cycle; none of a step that is too short."""
    out, first = round(LEFT_OUT_CYCLES * cycle), UNSETTLED_CYCLES * cycle
    for begin, end in zip((first - out, *steps), (*steps, samples + out - 2 * cycle), strict=True):
        if end - begin - 2 * out >= FEWEST_CYCLES * cycle:
            yield np.arange(begin + out, end - out, max(1, cycle // 2))


@dataclass(frozen=True, slots=True)
class _Course:
    """What is fitted. torque: its integral [N m s].  known_ohm: R of the last step; None: it is fitted."""

    lam: Array
    torque: Array
    w_s: float
    rate_hz: float
    sections: list[NDArray[np.int64]]
    known_ohm: float | None

    def fitted(self, law: LoadLaw) -> tuple[float, LoadLaw, Array, Array]:
        """Fit under a load law; return residual [rad/s], law, p / J, p T_L / J and all R, and the speed."""
        times = np.concatenate(self.sections)
        which = np.repeat(np.arange(len(self.sections)), [one.size for one in self.sections])
        load = np.arange(1, self.lam.size + 1) / self.rate_hz
        speed = self.w_s * np.arange(self.lam.size) / self.lam.size
        for _ in range(1 if law is LoadLaw.CONSTANT else ROUNDS):
            if law is not LoadLaw.CONSTANT:
                load = np.cumsum(np.clip(speed / self.w_s, 0.0, 1.0) ** int(law)) / self.rate_hz
            basis = np.zeros((times.size, 2 + len(self.sections)))
            basis[:, 0], basis[:, 1] = self.torque[times], -load[times]
            basis[np.arange(times.size), 2 + which] = self.lam[times]
            unknowns = self._solved(basis)
            speed = unknowns[0] * self.torque - unknowns[1] * load
        residual = float(np.sqrt(np.mean((basis @ unknowns - self.w_s) ** 2)))
        return residual, law, unknowns, np.asarray(speed)

    def _solved(self, basis: Array) -> Array:
        wanted = np.full(len(basis), self.w_s)
        if self.known_ohm is None:
            return np.asarray(np.linalg.lstsq(basis, wanted)[0])
        free = np.linalg.lstsq(basis[:, :-1], wanted - self.known_ohm * basis[:, -1])[0]
        return np.append(free, self.known_ohm)
