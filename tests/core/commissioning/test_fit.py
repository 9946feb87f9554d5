"""Fits of starts from points at which the model's current is no number."""

import numpy as np
import pytest

from core.commissioning.errors import DivergenceError
from core.commissioning.fit import Records
from core.commissioning.prior import prior_of
from core.commissioning.start_detection import start_of
from core.machines.candidates import LoadLaw
from testing.machines.motors import MEDIUM
from testing.machines.starts import StartRecord


def test_a_fit_that_begins_where_the_current_has_no_bound_names_the_start() -> None:
    start = start_of(StartRecord(duration_s=0.5).of(MEDIUM), MEDIUM.nameplate, MEDIUM.channels)
    records = Records([start], prior_of(MEDIUM.nameplate, MEDIUM.parameters), LoadLaw.QUADRATIC)
    lower, upper = records.coordinates.bounds()
    drawn = np.random.default_rng(1).uniform(lower, upper, (500, lower.size))
    beyond = drawn[np.isinf(records.squared_errors(drawn))]
    assert beyond.size

    with pytest.raises(DivergenceError, match=f"{start.source}: start: expected .* grows without bound"):
        records.fit(beyond[0], np.ones(lower.size, dtype=np.bool_))
