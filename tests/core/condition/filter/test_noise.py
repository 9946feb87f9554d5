"""The noise of y, learnt from record to record."""

from typing import cast

import numpy as np
import pytest

from core.condition.filter.kalman import FIRST_KNOWN, learn_noise, predict, update
from core.condition.filter.state import FILTER, FilterState


@pytest.mark.parametrize("claimed", [0.2, 5.0])
@pytest.mark.parametrize("seed", range(3))
def test_noise_is_learnt_from_few_records_though_temperature_explains_some(claimed: float, seed: int) -> None:
    true = 2e-3**2
    state = cast(FilterState, np.zeros(1, FILTER).view(np.recarray)[0])
    state.P[:] = np.diag([1e-3**2] * 4 + [0.1**2] * 2 + [0.08**2])
    state.nominal, state.s2, state.noise_known = 1.0, claimed * true, FIRST_KNOWN
    random = np.random.default_rng(seed)
    j2 = 0.012 + 0j
    for _ in range(60):
        noise = np.sqrt(true / 2.0) * complex(*random.normal(size=2))
        predict(state, 3600.0)
        update(state, 0.08 * random.normal() * j2 + noise, 0.5 + 0j, j2, bounded=False, changed_by=(0.0, 0.0))
        learn_noise(state)
        state.records += 1.0
    assert 0.5 < state.s2 / true < 2.0
