"""Candidates without a finite answer: they are told as such, end, and leave the others as they are."""

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines import batch, delay, discretisation, kernel, steady_state, turning_rotor
from core.machines.base import StatorModel
from core.machines.broken_bars import BrokenBars
from core.machines.candidates import Candidates
from core.machines.playback import Playback, Window
from core.machines.split_winding import SplitWinding
from core.machines.supply import supply
from core.optimisers import hcpa
from testing.machines.motors import REFERENCE

Array = NDArray[np.float64]
RATE, SAMPLES = 10_000.0, 1_000
W_S = 2.0 * np.pi * 50.0
COMPILED = [
    (module, name)
    for module in (batch, delay, discretisation, kernel, steady_state, turning_rotor)
    for name, function in vars(module).items()
    if hasattr(function, "targetoptions")
]


MODELS = (SplitWinding(), BrokenBars())


def playback(model: StatorModel) -> Playback:
    angle = W_S / RATE * np.arange(SAMPLES)
    voltage = 380.0 * np.stack([np.cos(angle), np.sin(angle)])
    phasor = 380.0 * np.array([1.0 + 0.0j, -1.0j], dtype=np.complex128)
    return Playback(model, REFERENCE, supply(voltage, RATE, 50.0, phasor), Window(250, 750, 300))


def candidates(fault_level: list[float], load_level: list[float]) -> Candidates:
    n = len(fault_level)
    return Candidates(np.array(fault_level), np.zeros(n, np.int64), np.array(load_level), np.zeros(n))


@pytest.mark.parametrize(("module", "name"), COMPILED, ids=[name for _, name in COMPILED])
def test_no_function_is_compiled_as_if_all_numbers_were_finite(module: object, name: str) -> None:
    allowed = getattr(module, name).targetoptions["fastmath"]
    assert set(allowed) == {"contract", "reassoc", "nsz", "arcp"}


@pytest.mark.parametrize(
    ("model", "field", "value"),
    [
        *((model, "fault_level", np.nan) for model in MODELS),
        *((model, "load_level", value) for model in MODELS for value in (np.nan, np.inf, -np.inf)),
        *((SplitWinding(), field, np.nan) for field in ("leakage", "axis_rad", "linkage")),
    ],
)
@pytest.mark.filterwarnings("ignore:.*:RuntimeWarning")
def test_what_is_not_finite_is_infinitely_far_and_changes_nothing_else(
    model: StatorModel, field: str, value: float
) -> None:
    measured = np.ones((2, SAMPLES))
    played = playback(model)
    good = candidates([0.02, 0.04, 0.06], [0.5, 0.4, 0.3])
    expected = played.squared_error(good, measured)
    bad = candidates([0.02, 0.05, 0.04, 0.06], [0.5, 0.5, 0.4, 0.3])
    getattr(bad, field)[1] = value
    found = played.squared_error(bad, measured)
    assert np.isfinite(expected).all()
    assert found[1] == np.inf
    np.testing.assert_allclose(found[[0, 2, 3]], expected, rtol=1e-6)


@pytest.mark.filterwarnings("ignore:.*:RuntimeWarning")
def test_what_is_not_finite_is_not_balanced() -> None:
    state = playback(SplitWinding()).steady_state(candidates([np.nan, 0.02, 0.02], [0.5, np.nan, 0.5]))
    assert state.balanced.tolist() == [False, False, True]


@pytest.mark.filterwarnings("ignore:.*:RuntimeWarning")
def test_a_search_never_ends_at_what_is_not_finite() -> None:
    played, measured = playback(SplitWinding()), np.zeros((2, SAMPLES))

    def cost(points: Array) -> Array:
        # Half of the box has no answer.
        levels = np.where(points[:, 0] > 0.1, np.nan, points[:, 0])
        return played.squared_error(candidates(levels.tolist(), points[:, 1].tolist()), measured)

    result = hcpa.minimise(
        cost, [(0.0, 0.2), (0.0, 1.0)], adaptiveness=0.5, fineness=10, exclusion=0.0, max_global=60,
        max_local=0, batch=True,
    )  # fmt: skip
    assert np.isfinite(result.fun)
    assert result.x[0] <= 0.1
    assert (result.costs[result.points[:, 0] > 0.1] == np.inf).all()


def test_the_hold_of_a_matrix_that_is_not_finite_is_not_finite_and_found_in_no_time() -> None:
    decay = -np.eye(5)
    decay[0, 0] = -np.inf
    hold = discretisation.Hold(np.zeros((5, 5)), np.zeros((5, 2)), np.zeros((5, 2)), np.zeros((5, 2)))
    discretisation.first_order_hold(decay, 1e-4, hold)
    assert not np.isfinite(hold.E).any(axis=1).all()
