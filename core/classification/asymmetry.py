"""Evidence of what makes a record's phases unlike: a linear Gaussian model of its phasors.

The figures of a record are the asymmetry y of voltages and currents, V2/V1 and V0/V1, I0/I1
(`core.condition.measuring.measurement`) and how far the current lies beside the motor's circle
(`core.diagnosis.parameter_check`). Each cause adds a signature of unknown size to them; channels within their
class, parameters within their tolerances, the supply and noise add the rest, S. Sizes are Gaussian, too, so
that the likelihood ratio of one or two causes with signatures U and covariance of sizes D is exact:

    Q = U' S^-1 U,   l = U' S^-1 d
    ln BF = l' (Q + D^-1)^-1 l / 2 - ln det(I + D Q) / 2  (+ ln 2 Phi(m / sd) where a size is positive)

Three spreads of the sizes are weighed alike, and so are a cause's places: phases, channels and paths.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import log
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

from core.classification.causes import Cause, Causes
from core.classification.evidence import Block
from core.classification.record_model import RecordModel
from core.condition.observation import Observation
from core.machines.parameters import Motor

SCALES: Final = (1.0, 3.0, 9.0)
"""Multiples of a size's usual spread that are weighed alike: faults come small and large."""


def asymmetry_block(observation: Observation, motor: Motor) -> Block:
    """Return the evidence of a record's phasors.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.
    motor : Motor
        The motor, with tolerances and the class of its sensors.

    Returns
    -------
    Block
        Evidence for shorted turns, joints, channels, supply and parameters.

    Raises
    ------
    ObservationError
        If a number is missing, infinite or impossible, or the motor was not running on three phases.
    """
    model = RecordModel(observation, motor)
    signatures = model.signatures
    singles, pairs = _Weighed(model).fits()
    # The places and spreads of a cause are alternatives: their evidence adds up.
    by_cause: dict[Causes, list[NDArray[np.float64]]] = {}
    best: dict[Cause, tuple[float, str]] = {}
    for fits in (singles, pairs):
        for (*members,), evidence in zip(fits.groups, fits.log_evidence, strict=True):
            causes = frozenset(signatures[k].cause for k in members)
            by_cause.setdefault(causes, []).append(evidence)
    for g, (k,) in enumerate(singles.groups):
        s = int(np.argmax(singles.log_evidence[g]))
        found = float(singles.log_evidence[g, s])
        cause = signatures[k].cause
        if cause not in best or found > best[cause][0]:
            words = signatures[k].words(float(singles.size[g, s]), float(singles.deviation[g, s]))
            best[cause] = found, words
    return Block(
        causes=frozenset(one.cause for one in signatures),
        log_likelihood={
            causes: float(np.logaddexp.reduce(found, axis=None)) for causes, found in by_cause.items()
        },
        figures={cause: words for cause, (_, words) in best.items()},
    )


@dataclass(frozen=True, slots=True)
class _Fits:
    """Groups of one or two signatures, fitted to a record at each combination of spreads.

    groups: numbers of the signatures.  log_evidence: of each group and combination, which share it alike.
    size, deviation: of the group's first signature.
    """

    groups: Sequence[tuple[int, ...]]
    log_evidence: NDArray[np.float64]
    size: NDArray[np.float64]
    deviation: NDArray[np.float64]


class _Weighed:
    """All signatures of a record against its noise, singly and in pairs."""

    def __init__(self, model: RecordModel) -> None:
        self.signatures = model.signatures
        self.width = max(one.columns.shape[1] for one in self.signatures)
        n = model.figures.size
        # Signatures with fewer columns are filled up with nothing, whose spread does not count.
        columns = np.zeros((len(self.signatures), n, self.width))
        spread = np.ones((len(self.signatures), self.width))
        for k, one in enumerate(self.signatures):
            count = one.columns.shape[1]
            columns[k, :, :count], spread[k, :count] = one.columns, one.spread
        flat = columns.transpose(1, 0, 2).reshape(n, -1)
        weighed = np.linalg.solve(model.covariance, np.column_stack([flat, model.figures]))
        self.information = flat.T @ weighed[:, :-1]
        self.projected = flat.T @ weighed[:, -1]
        self.spread = spread

    def fits(self) -> tuple[_Fits, _Fits]:
        """Return the fits of all places of all causes, and those of all pairs of different causes."""
        places = range(len(self.signatures))
        pairs = [two for two in combinations(places, 2) if len({self.signatures[k].cause for k in two}) == 2]
        return self._fitted([(k,) for k in places]), self._fitted(pairs)

    def _fitted(self, groups: Sequence[tuple[int, ...]]) -> _Fits:
        """Return the fits of groups of equally many signatures, at each combination of spreads."""
        count = len(groups[0])
        scales = np.array(list(product(SCALES, repeat=count)))
        members = np.array(groups)
        rows = (members[:, :, np.newaxis] * self.width + np.arange(self.width)).reshape(len(groups), -1)
        Q = self.information[rows[:, :, np.newaxis], rows[:, np.newaxis, :]][:, np.newaxis]
        root = self.spread[members][:, np.newaxis] * scales[np.newaxis, :, :, np.newaxis]
        root = root.reshape(len(groups), len(scales), -1)
        inner = np.eye(rows.shape[1]) + root[..., :, np.newaxis] * Q * root[..., np.newaxis, :]
        inverse = np.linalg.inv(inner)
        scaled = root * self.projected[rows][:, np.newaxis]
        solved = np.einsum("gsij,gsj->gsi", inverse, scaled)
        evidence = 0.5 * np.einsum("gsi,gsi->gs", scaled, solved) - 0.5 * np.linalg.slogdet(inner)[1]
        size = (root * solved)[..., :: self.width]
        deviation = root[..., :: self.width] * np.sqrt(
            np.diagonal(inverse, axis1=-2, axis2=-1)[..., :: self.width]
        )
        one_sided = np.array([[self.signatures[k].one_sided for k in group] for group in groups])
        positive = log(2.0) + log_ndtr(size / deviation)
        evidence += np.where(one_sided[:, np.newaxis], positive, 0.0).sum(axis=-1)
        share = np.log([[self.signatures[k].share for k in group] for group in groups]).sum(axis=-1)
        evidence += share[:, np.newaxis] - log(len(scales))
        return _Fits(groups, evidence, size[..., 0], deviation[..., 0])
