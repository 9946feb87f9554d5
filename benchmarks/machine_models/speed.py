"""Machine models: one candidate over 5,000 samples (0.5 s at 10 kHz), beside scipy and motulator."""

import tracemalloc
from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.typing import NDArray

from benchmarks.machine_models.motulator_peer import motulator_seconds
from benchmarks.stopwatch import best_of
from core.machines.broken_bars import BrokenBars
from core.machines.candidates import Candidates
from core.machines.high_resistance import HighResistanceConnection
from core.machines.playback import Beginning, Playback, Window
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding
from core.machines.supply import Supply, supply
from testing.machines.motors import REFERENCE
from testing.machines.page_equations import integrate

RATE, SAMPLES, MARGIN = 10_000.0, 5_000, 250
W_S = 2.0 * np.pi * 50.0
THESIS_SECONDS = 0.2
"""A model evaluation in Table 6.1."""


def voltage_at(t: NDArray[np.float64] | float) -> NDArray[np.float64]:
    angle = W_S * np.asarray(t)
    return np.asarray(380.0 * np.array([np.cos(angle), np.sin(angle)]), dtype=np.float64)


def feed(samples: int) -> tuple[Supply, Window, NDArray[np.float64]]:
    """Supply, window of `samples` in its middle, and currents to compare with."""
    t = np.arange(samples + 2 * MARGIN) / RATE
    forward = 380.0 * np.array([1.0 + 0.0j, -1.0j], dtype=np.complex128)
    window = Window(MARGIN, MARGIN + samples, MARGIN + 1)
    return supply(voltage_at(t), RATE, 50.0, forward), window, np.zeros((2, t.size))


def batch(count: int, *, spread_delays: bool = False) -> Candidates:
    rng = np.random.default_rng(count)
    return Candidates(
        rng.uniform(0.0, 0.2, count), rng.integers(0, 3, count), rng.uniform(0.0, 1.0, count),
        rng.uniform(0.0, 0.02, count) if spread_delays else np.zeros(count),
    )  # fmt: skip


def measure() -> Iterator[str]:
    peer = best_of(1, _solve_ivp)
    yield f"scipy solve_ivp, RK45 at rtol 1e-6, split winding: {peer * 1e6:10.0f} us a candidate"
    other = motulator_seconds(REFERENCE, SAMPLES, RATE, load_level=0.5)
    if other is None:
        yield "motulator, healthy machine: not installed, skipped"
    else:
        yield f"motulator, healthy machine, steps of 0.1 ms: {other * 1e6:10.0f} us"
    volts, window, measured = feed(SAMPLES)
    for model in (SplitWinding(), ShortedWinding(), HighResistanceConnection()):
        playback = Playback(model, REFERENCE, volts, window)
        for count in (1, 8, 16, 128):
            seconds = _cost(playback, batch(count), measured, 20)
            yield (
                f"{model.name:16s} batch of {count:4d}: {seconds * 1e6:8.1f} us a candidate, "
                f"{peer / seconds:8.0f} times faster than solve_ivp, "
                f"{THESIS_SECONDS / seconds:8.0f} times faster than the thesis"
            )
    playback = Playback(SplitWinding(), REFERENCE, volts, window)
    split = Playback(SplitWinding(), REFERENCE, volts, window)
    starting = Playback(SplitWinding(), REFERENCE, volts, window, beginning=Beginning.REST)
    turning = Playback(BrokenBars(), REFERENCE, volts, window)
    for name, playback, candidates in (
        ("split-winding, every T_d different", split, batch(16, spread_delays=True)),
        ("split-winding, from rest", starting, batch(16)),
        ("broken-bars", turning, batch(16)),
    ):
        seconds = _cost(playback, candidates, measured, 10)
        yield f"{name:34s} batch of   16: {seconds * 1e6:8.1f} us a candidate"
    yield from _growth()


def _solve_ivp() -> object:
    times = np.arange(SAMPLES) / RATE
    return integrate(
        "split-winding", REFERENCE, 0.05, 1, 0.5, voltage_at, np.zeros(5), 300.0, times, "RK45", 1e-6
    )


def _cost(playback: Playback, candidates: Candidates, measured: NDArray[np.float64], times: int) -> float:
    """Seconds a candidate, all of its work included: matrices, steady state, discretisation, stepping."""
    return best_of(times, partial(playback.squared_error, candidates, measured)) / len(candidates)


def _growth() -> Iterator[str]:
    """Cost per sample and candidate over record length and batch size, and the most memory held meanwhile."""
    for seconds in (0.1, 0.5, 1.0, 5.0, 10.0):
        yield _growth_line(round(seconds * RATE), 16)
    for count in (1, 4, 16, 64, 256, 1_024):
        yield _growth_line(SAMPLES, count)


def _growth_line(samples: int, count: int) -> str:
    volts, window, measured = feed(samples)
    playback, candidates = Playback(SplitWinding(), REFERENCE, volts, window), batch(count)
    seconds = _cost(playback, candidates, measured, 3)
    # Of what the process allocates anew during the call; the record itself is there before.
    tracemalloc.start()
    playback.squared_error(candidates, measured)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return (
        f"{samples / RATE:5.1f} s x {count:5d} candidates: {seconds * 1e9 / samples:6.2f} ns a sample and "
        f"candidate, {seconds * count * 1e3:9.2f} ms in all, {peak / 1e6:6.2f} MB"
    )
