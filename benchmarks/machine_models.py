"""Machine models: one candidate over 5,000 samples (0.5 s at 10 kHz), against scipy's RK45 at rtol 1e-6."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from benchmarks.stopwatch import best_of
from core.machines.playback import Candidates, Playback, Window
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding
from core.machines.supply import supply
from tests.core.motors import REFERENCE
from tests.core.page_equations import integrate

RATE, SAMPLES = 10_000.0, 5_000
W_S = 2.0 * np.pi * 50.0
THESIS_SECONDS = 0.2
"""A model evaluation in Table 6.1."""


def voltage_at(t: NDArray[np.float64] | float) -> NDArray[np.float64]:
    angle = W_S * np.asarray(t)
    return 380.0 * np.array([np.cos(angle), np.sin(angle)])


def measure() -> Iterator[str]:
    margin = 250
    t = np.arange(SAMPLES + 2 * margin) / RATE
    feed = supply(voltage_at(t), RATE, 50.0, 380.0 * np.array([1.0 + 0.0j, -1.0j], dtype=np.complex128))
    window = Window(margin, margin + SAMPLES, margin + 1)
    measured = np.zeros((2, t.size))
    rng = np.random.default_rng(0)
    times = t[:SAMPLES]
    start = np.zeros(5)
    peer = best_of(
        1,
        lambda: integrate(
            "split-winding",
            REFERENCE,
            0.05,
            1,
            0.5,
            voltage_at,
            start,
            300.0,
            times,
            method="RK45",
            rtol=1e-6,
        ),
    )
    yield f"scipy solve_ivp RK45, rtol 1e-6, split winding: {peer * 1e6:10.0f} us a candidate"
    for model in (SplitWinding(), ShortedWinding()):
        playback = Playback(model, REFERENCE, feed, window)
        for count in (1, 8, 16, 128):
            batch = Candidates(
                rng.uniform(0.0, 0.2, count), rng.integers(0, 3, count), rng.uniform(0.0, 1.0, count),
                np.zeros(count), np.zeros(count),
            )  # fmt: skip
            seconds = best_of(20, lambda b=batch, p=playback: p.squared_error(b, measured)) / count  # type: ignore[misc]
            yield (
                f"{model.name:16s} batch of {count:4d}: {seconds * 1e6:8.1f} us a candidate, "
                f"{peer / seconds:8.0f} times faster than solve_ivp, "
                f"{THESIS_SECONDS / seconds:8.0f} times faster than the thesis"
            )
