"""Follows the parameters of a motor from record to record: an extended Kalman filter of seventeen unknowns.

The positive sequence tells one figure a record, its distance from the circle of the motor: records at
different loads together tell R_s, L_sigma and L_M. The negative sequence tells Z2 = R_s + R_R/2 + j X_sigma
where the supply's unbalance varies, and with it R_R; so does each start by itself. What the first records
show is the reference; from then on changes may wander, so that old records are forgotten.

A single record beside all others counts little. Two in a row say that something is another at once.
"""

from dataclasses import dataclass, field
from math import isfinite
from typing import Final

import numpy as np

from core.condition.errors import ObservationError
from core.condition.measuring.bounds import check
from core.condition.observation import Observation
from core.machines.base import Array
from core.machines.parameters import Motor
from core.tracking.drift import FOLLOWED, Drift, see_all
from core.tracking.record import Asymmetry, Rated, Row, asymmetry, impedance_row, rated_figures
from core.tracking.unknowns import (
    CHANGES,
    STATES,
    Unknown,
    first_covariance,
    first_guess,
    kept,
    of_asymmetry_jump,
    of_jump,
    of_unknown_changes,
    other_sensors,
)
from core.units import NANOSECONDS_PER_SECOND

REFERENCE_RECORDS: Final = 30
"""First records of a motor, in which it is taken to stay as it is."""
OUTLIER: Final = 12.25
"""Largest squared surprise over its variance that counts."""
AT_ONCE: Final = 2
"""Outliers in a row that are believed."""
NOISE_MEMORY, NOISE_FIRST = 100.0, 10.0
LEAST_LEARNT: Final = 0.1
"""Share of the noise that a record tells of itself which it may turn out to have."""
CLIPPED: Final = 9.0
VARYING: Final = 50.0
"""Variance of Z2 I2/V1 over that of its noise from which on a supply's unbalance varies. Noise of the
currents is in I2 and in the asymmetry: it makes Z2 seem smaller, by at most a fiftieth then."""
VARYING_MEMORY: Final = 100.0
STANDING: Final = [Unknown.LEAKAGE, Unknown.MAGNETISING, Unknown.ROTOR_RESISTANCE]
LARGEST_STANDING: Final = (0.7, 2.0)
"""What the first records may show over the file's figures, where a change is told as a fraction of it."""
CAGE_WARMER: Final = 0.03
"""Standard deviation of R_r over R_s from start to start: cage and winding are not always alike warm."""


@dataclass(slots=True)
class Noise:
    """Variance of what records have beside the state, over what they say of it themselves.

    Parameters
    ----------
    factor : float, default 1.0
        The factor.
    records : float, default 0.0
        Records that it follows from.
    outliers : int, default 0
        Outliers in a row until now.
    """

    factor: float = 1.0
    records: float = 0.0
    outliers: int = 0

    def learn(self, square: float, share: float) -> None:
        """Learn from a record.

        Parameters
        ----------
        square : float
            Squared surprise over its variance.
        share : float
            Share of the noise in that variance.
        """
        self.records = min(self.records + 1.0, NOISE_MEMORY)
        step = share * (min(square, CLIPPED) - 1.0) / (self.records + NOISE_FIRST)
        self.factor = max(self.factor * (1.0 + step), LEAST_LEARNT)

    def is_step(self, square: float) -> bool:
        """Tell whether a record is one outlier too many.

        Parameters
        ----------
        square : float
            Squared surprise over its variance.

        Returns
        -------
        bool
            Whether what is measured is another at once.
        """
        self.outliers = self.outliers + 1 if square > OUTLIER else 0
        if self.outliers < AT_ONCE:
            return False
        self.outliers = 0
        return True


@dataclass(slots=True)
class Follower:
    """All that is known of a motor after some of its records.

    Parameters
    ----------
    motor : Motor
        The motor.
    x : ndarray, shape (STATES,)
        State.
    P : ndarray, shape (STATES, STATES)
        Its covariance.
    records : int
        Records until now.
    time_ns : int or None
        Time of the latest [ns].
    recorder : str
        What recorded it.
    impedance_noise, asymmetry_noise : Noise
        Noise of the two measurements.
    drop_mean : complex
        Mean of Z2 I2/V1 over the latest hundred records.
    drop_variance, drop_noise : float
        Variance of Z2 I2/V1, and that of the asymmetry's noise.
    loads : tuple of float or None
        Least and largest load level of the records.
    drifts : list of Drift
        What is told of each parameter, in the order of `FOLLOWED`.
    """

    motor: Motor
    x: Array = field(default_factory=first_guess)
    P: Array = field(default_factory=lambda: np.zeros((STATES, STATES)))
    records: int = 0
    time_ns: int | None = None
    recorder: str = ""
    impedance_noise: Noise = field(default_factory=Noise)
    asymmetry_noise: Noise = field(default_factory=Noise)
    drop_mean: complex = 0j
    drop_variance: float = 0.0
    drop_noise: float = 0.0
    loads: tuple[float, float] | None = None
    drifts: list[Drift] = field(default_factory=lambda: [Drift() for _ in FOLLOWED])
    rated: Rated = field(init=False)

    def __post_init__(self) -> None:
        self.rated = rated_figures(self.motor)
        if self.time_ns is None:
            self.P = first_covariance(self.motor)

    @property
    def has_reference(self) -> bool:
        """Whether there are enough first records to compare with."""
        return self.records >= REFERENCE_RECORDS

    @property
    def unbalance_varies(self) -> bool:
        """Whether the supply's unbalance varies enough for the negative sequence to tell Z2."""
        return self.drop_variance > VARYING * self.drop_noise

    @property
    def changes(self) -> tuple[Array, Array]:
        """Changes since the first records, in the order of `FOLLOWED`, and their covariance.

        They are fractions of what the first records show; that of R_s is one of the file's figure, because a
        sensor's error may be as large as R_s.
        """
        scales = self._scales
        return scales * self.x[CHANGES], np.outer(scales, scales) * self.P[CHANGES, CHANGES]

    @property
    def _scales(self) -> Array:
        """The file's figures over those of the first records."""
        low, high = LARGEST_STANDING
        return np.asarray(1.0 / np.array([1.0, *np.clip(1.0 + self.x[STANDING], low, high)]))

    def follow(self, observation: Observation) -> bool:
        """Take one record in.

        Parameters
        ----------
        observation : Observation
            The next record in the order of time.

        Returns
        -------
        bool
            Whether it counts: not one with impossible figures, nor one without current.
        """
        try:
            check(observation)
        except ObservationError:
            return False
        if observation.positive_current_A == 0.0:
            return False
        self._let_time_pass(observation.time_ns)
        if self.recorder not in ("", observation.recorder):
            self.meet_other_sensors()
        self.recorder = observation.recorder
        row = impedance_row(observation, self.rated, self.x)
        if self.impedance_noise.is_step(self._square(row, self.impedance_noise)):
            self.P += of_jump()
        self._take(row, self.impedance_noise)
        self._take_asymmetry(asymmetry(observation, self.rated, self.x))
        self.records += 1
        if self.records == REFERENCE_RECORDS:
            self.P += of_unknown_changes()
        level = observation.load_level
        if level is not None and isfinite(level):
            low, high = self.loads or (level, level)
            self.loads = min(low, level), max(high, level)
        self._look(observation.time_ns)
        return True

    def follow_start(self, time_ns: int, rotor_over_stator: float, deviation: float) -> None:
        """Take in what a start tells of the rotor.

        Parameters
        ----------
        time_ns : int
            Time of the start [ns].
        rotor_over_stator : float
            R_r over R_s, both as the start tells them: a temperature that they have in common drops out.
        deviation : float
            Its standard deviation, relative.
        """
        self._let_time_pass(time_ns)
        machine = self.motor.parameters
        file = machine.rotor_resistance_ohm / machine.stator_resistance_ohm
        standing, left = 1.0 + float(self.x[Unknown.STARTS]), 1.0 + float(self.changes[0][-1])
        slopes = np.zeros(STATES)
        slopes[Unknown.STARTS], slopes[Unknown.ROTOR_RESISTANCE_CHANGE] = left, standing * self._scales[-1]
        surprise = rotor_over_stator / file - standing * left
        row = Row(surprise, slopes, standing**2 * (deviation**2 + CAGE_WARMER**2))
        self._take(row, Noise())
        self._look(time_ns)

    def meet_other_sensors(self) -> None:
        """Take the standing errors of the sensors for as uncertain as their class says."""
        self.P += other_sensors(self.motor)

    def _look(self, time_ns: int) -> None:
        change, covariance = self.changes
        see_all(self.drifts, change, np.sqrt(np.diag(covariance)), time_ns)

    def _let_time_pass(self, time_ns: int) -> None:
        elapsed_ns = 0 if self.time_ns is None else max(0, time_ns - self.time_ns)
        factors, variances = kept(elapsed_ns / NANOSECONDS_PER_SECOND, changes=self.has_reference)
        self.x *= factors
        self.P *= np.outer(factors, factors)
        self.P[np.diag_indices(STATES)] += variances
        self.time_ns = time_ns

    def _take_asymmetry(self, found: Asymmetry) -> None:
        noise = self.asymmetry_noise
        self._see_unbalance(found)
        square = max(self._square(row, noise) for row in found.rows)
        if noise.is_step(square):
            self.P += of_asymmetry_jump()
        teaches = slice(None) if self.unbalance_varies else slice(Unknown.E_REAL, None)
        before = self.x
        for row in found.rows:
            left = row.surprise - float(row.slopes @ (self.x - before))
            self._take(Row(left, row.slopes, row.variance), noise, teaches)

    def _see_unbalance(self, found: Asymmetry) -> None:
        share = 1.0 / min(self.records + 1.0, VARYING_MEMORY)
        apart = found.drop - self.drop_mean
        self.drop_mean += share * apart
        self.drop_variance += share * ((1.0 - share) * abs(apart) ** 2 - self.drop_variance)
        variance = sum(row.variance for row in found.rows) * self.asymmetry_noise.factor
        self.drop_noise += share * (variance - self.drop_noise)

    def _square(self, row: Row, noise: Noise) -> float:
        variance = float(row.slopes @ self.P @ row.slopes) + row.variance * noise.factor
        return row.surprise**2 / variance

    def _take(self, row: Row, noise: Noise, teaches: slice = slice(None)) -> None:
        """Take one figure in; an outlier as if it had more noise. teaches: the unknowns that it changes."""
        h = row.slopes
        Ph = self.P @ h
        known, R = float(h @ Ph), row.variance * noise.factor
        S = known + R
        square = row.surprise**2 / S
        noise.learn(square, R / S)
        S = max(S, row.surprise**2 / OUTLIER)
        K = np.zeros(STATES)
        K[teaches] = Ph[teaches] / S
        self.x = self.x + K * row.surprise
        cross = np.outer(K, Ph)
        self.P = self.P - cross - cross.T + S * np.outer(K, K)
