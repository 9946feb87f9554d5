"""Starts of machines with deep bars and leakage that saturates: measured voltages through each candidate.

`starting` steps machines whose matrices are constant, exactly. Here the leakage follows the current and the
rotor has two loops (`deep_bars`), so the fluxes are integrated by the classical Runge-Kutta method of fourth
order on Clarke axes, with the voltage at the middle of each step too:

    d(psi_s)/dt = v - R_s i_s
    d(psi_o)/dt = -R_o (i_r - i_i) + j w psi_o        psi_o = f L_c i_r + L_m (i_s + i_r)
    d(psi_i)/dt = -R_i i_i + j w psi_i                psi_i = psi_o + L_i i_i
    dw/dt = p^2/J (L_m Im(i_r* i_s) - T_load / p)     psi_s = f L_ls i_s + L_m (i_s + i_r)

with i_r = i_o + i_i and f = f(|i_s|). The load may change once, along a straight line: only here does it
depend on time.
"""

from dataclasses import dataclass, field
from functools import cached_property, partial
from math import sqrt
from typing import NamedTuple

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.deep_bars import unsaturated
from core.machines.delay import delay_voltage
from core.machines.parameters import MAGNETISING_OVER_SELF
from core.machines.playback import Trajectories
from core.machines.starting import StartCandidates, StartPlayback

_unsaturated = compiled(unsaturated)
TABLED = 512
"""Steps of the table of a leakage that saturates: a power at each step would take most of the time."""
RMS_OVER_CLARKE = 1.0 / sqrt(3.0)
"""Current of a winding, rms, over the length of the vector on Clarke axes."""


@dataclass(frozen=True, slots=True)
class DeepBarCandidates(StartCandidates):
    """A batch of machines whose rotor and leakage change from a start to running.

    Parameters
    ----------
    resistance_ratio, leakage_share : ndarray, shape (candidates,)
        Of `deep_bars.DeepBars`; the parameters are those at a small slip and at running currents.
    saturating_share, knee_current_A, knee_sharpness : ndarray, shape (candidates,)
        Of `deep_bars.LeakageSaturation`.
    load_change : ndarray, shape (candidates,)
        By how much the load level changes, once; 0 where it stays.
    change_begins_s, change_lasts_s : ndarray, shape (candidates,)
        From when on after the playback's begin, and how long [s].
    """

    resistance_ratio: Array
    leakage_share: Array
    saturating_share: Array
    knee_current_A: Array
    knee_sharpness: Array
    load_change: Array = field(default_factory=partial(np.zeros, 1))
    change_begins_s: Array = field(default_factory=partial(np.zeros, 1))
    change_lasts_s: Array = field(default_factory=partial(np.ones, 1))


class Loops(NamedTuple):
    """One machine as it is stepped.

    Parameters
    ----------
    R_s, R_o, R_i : float
        Resistances [ohm].
    L_ls, L_c : float
        Leakages [H].
    inverse_L_i : float
        1 / L_i [1/H].
    L_m : float
        Magnetising inductance [H].
    knee : float
        Length of the current's vector about which leakage saturates [A].
    left : ndarray, shape (TABLED + 1,)
        Leakage over that of small currents, at equal steps of u = x / (1 + x), x the current over the knee.
    gain : float
        p^2 / J [1/(kg m^2)].
    load, law : float
        T_load / p = load w^law, up to a change of the load.
    change : float
        What is added to `load` when the change is over.
    begins, lasts : float
        Begin and length of the change [columns].
    """

    R_s: float
    R_o: float
    R_i: float
    L_ls: float
    L_c: float
    inverse_L_i: float
    L_m: float
    knee: float
    left: Array
    gain: float
    load: float
    law: int
    change: float
    begins: float
    lasts: float


State = tuple[float, float, float, float, float, float, float]
"""psi_s, psi_o and psi_i on both axes, and the electrical speed. Complex numbers take twice the time."""


@compiled
def _tabled(share: float, sharpness: float) -> Array:
    """Return the leakage over that of small currents, as `Loops.left` has it."""
    left = np.empty(TABLED + 1)
    for k in range(TABLED):
        left[k] = 1.0 - share + share * _unsaturated(k / (TABLED - k), sharpness)
    left[TABLED] = 1.0 - share
    return left


@compiled
def _currents(it: Loops, state: State, length: float) -> tuple[float, float, float, float]:
    """Return i_s and i_r on both axes; the leakage follows `length`, that of i_s a moment before."""
    at = TABLED * length / (length + it.knee)
    if not at < TABLED:
        at = TABLED - 1.0  # a current that has no bound
    below = int(at)
    f = it.left[below] + (at - below) * (it.left[below + 1] - it.left[below])
    L_s, L_r = f * it.L_ls + it.L_m, f * it.L_c + it.L_m
    inverse = 1.0 / (L_s * L_r - it.L_m**2)
    S, M, R = inverse * L_r, inverse * it.L_m, inverse * L_s
    return (
        S * state[0] - M * state[2],
        S * state[1] - M * state[3],
        R * state[2] - M * state[0],
        R * state[3] - M * state[1],
    )


@compiled
def _rates(
    it: Loops, v_a: float, v_b: float, state: State, length: float, column: float
) -> tuple[State, float]:
    """Return the rates of a state and the length of its stator current."""
    _, _, o_a, o_b, n_a, n_b, w = state
    s_a, s_b, r_a, r_b = _currents(it, state, length)
    i_a, i_b = it.inverse_L_i * (n_a - o_a), it.inverse_L_i * (n_b - o_b)
    demand = it.load
    if it.change != 0.0 and column > it.begins:
        demand += it.change * min((column - it.begins) / it.lasts, 1.0)
    for _ in range(it.law):
        demand *= w
    rates = (
        v_a - it.R_s * s_a,
        v_b - it.R_s * s_b,
        -it.R_o * (r_a - i_a) - w * o_b,
        -it.R_o * (r_b - i_b) + w * o_a,
        -it.R_i * i_a - w * n_b,
        -it.R_i * i_b + w * n_a,
        it.gain * (it.L_m * (r_a * s_b - r_b * s_a) - demand),
    )
    return rates, sqrt(s_a**2 + s_b**2)


@compiled
def _ahead(x: State, k: State, h: float) -> State:
    return (
        x[0] + h * k[0], x[1] + h * k[1], x[2] + h * k[2], x[3] + h * k[3], x[4] + h * k[4], x[5] + h * k[5],
        x[6] + h * k[6],
    )  # fmt: skip


@compiled
def _run(
    it: Loops, voltage: Array, between: Array, flux: Array, step_s: float, current: Array, speed: Array
) -> None:
    """Fill currents, shape (2, columns), and speed from rest; `between` has the voltage half a step later."""
    x = (flux[0], flux[1], 0.0, 0.0, 0.0, 0.0, 0.0)
    half, length = 0.5 * step_s, 0.0
    for n in range(speed.size):
        current[0, n], current[1, n], _, _ = _currents(it, x, length)
        length, speed[n] = sqrt(current[0, n] ** 2 + current[1, n] ** 2), x[6]
        if n == speed.size - 1:
            break
        k1, length = _rates(it, voltage[n, 0], voltage[n, 1], x, length, n)
        k2, length = _rates(it, between[n, 0], between[n, 1], _ahead(x, k1, half), length, n + 0.5)
        k3, length = _rates(it, between[n, 0], between[n, 1], _ahead(x, k2, half), length, n + 0.5)
        ahead = _ahead(x, k3, step_s)
        k4, length = _rates(it, voltage[n + 1, 0], voltage[n + 1, 1], ahead, length, n + 1.0)
        x = _ahead(_ahead(x, k1, half / 3.0), k2, step_s / 3.0)
        x = _ahead(_ahead(x, k3, step_s / 3.0), k4, half / 3.0)


@compiled
def _play(
    voltage: Array, first: int, delay_columns: Array, loops: Array, law: int, flux: Array, step_s: float,
    current: Array, speed: Array,
) -> None:  # fmt: skip
    """Run every candidate; loops has a row for each: share and sharpness stand where `Loops` has `left`."""
    columns = speed.shape[1]
    delayed, between = np.empty((columns, 2)), np.empty((columns - 1, 2))
    for c in range(loops.shape[0]):
        if c == 0 or delay_columns[c] != delay_columns[c - 1]:
            delay_voltage(voltage, delay_columns[c], first, delayed)
            delay_voltage(voltage, delay_columns[c] - 0.5, first, between)
        r = loops[c]
        left = _tabled(r[8], r[9])
        it = Loops(
            r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], left, r[10], r[11], law, r[12], r[13], r[14]
        )
        _run(it, delayed, between, flux[c], step_s, current[c], speed[c])


class DeepBarStartPlayback(StartPlayback):
    """Measured voltages from the instant of switching on; any number of such machines at rest."""

    def trajectories(self, candidates: StartCandidates) -> Trajectories:
        """Return currents and speed of every candidate at the compared samples.

        Parameters
        ----------
        candidates : DeepBarCandidates
            The batch of hypotheses.

        Returns
        -------
        Trajectories
            Currents and speeds.

        Raises
        ------
        ValueError
            If a time offset reaches beyond the voltages there are.
        """
        if not isinstance(candidates, DeepBarCandidates):
            raise TypeError(f"expected machines with deep bars, found {type(candidates).__name__}")
        self.require_voltages(candidates.time_offset_s)
        feed = self._feed
        count, columns = len(candidates), feed.last - feed.first
        current, speed = np.empty((count, 2, columns)), np.empty((count, columns))
        _play(
            self._sampled, feed.first, candidates.time_offset_s / feed.step_s, self._loops(candidates),
            int(self.load_law), candidates.switching_flux_Vs, feed.step_s, current, speed,
        )  # fmt: skip
        return Trajectories(current[:, :, self._wanted], speed[:, self._wanted])

    @cached_property
    def _sampled(self) -> Array:
        """Voltages as they were measured: what was put on them for steps of straight lines is taken off."""
        emphasised = self.supply.voltage
        sampled = emphasised.copy()
        sampled[1:-1] += (emphasised[2:] - 2.0 * emphasised[1:-1] + emphasised[:-2]) / 12.0
        return sampled

    def _loops(self, it: DeepBarCandidates) -> Array:
        """Return a row of `Loops` for each candidate, without the law. With a ratio of 1, R_i is left out."""
        ratio, share = it.resistance_ratio, it.leakage_share
        has_inner = ratio > 1.0
        outer = ratio * it.rotor_resistance_ohm
        inner = outer / np.where(has_inner, ratio - 1.0, 1.0)
        carried = outer / (outer + inner)
        between = np.where(has_inner, (1.0 - share) * it.rotor_leakage_H, 1.0)
        step_s = self._feed.step_s
        columns = (
            it.stator_resistance_ohm,
            outer,
            inner,
            it.stator_leakage_H,
            share * it.rotor_leakage_H,
            np.where(has_inner, carried**2 / between, 0.0),
            MAGNETISING_OVER_SELF * it.stator_self_inductance_H,
            it.knee_current_A / RMS_OVER_CLARKE,
            it.saturating_share,
            it.knee_sharpness,
            self.nameplate.pole_pairs**2 / it.inertia_kgm2,
            it.load_level * self._torque_per_pole_pair,
            it.load_change * self._torque_per_pole_pair,
            it.change_begins_s / step_s,
            it.change_lasts_s / step_s,
        )
        return np.ascontiguousarray(np.stack(np.broadcast_arrays(*columns), axis=1))
