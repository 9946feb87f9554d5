"""Plots of the thesis's chapter 5."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

mpl.use("Agg")
from matplotlib.figure import Figure

Array = NDArray[np.float64]


def plot_trajectories(path: Path, points: Array, truth: Array, symbols: Sequence[str]) -> None:
    """Every evaluated value of each unknown in the order of evaluation, the truth as a line."""
    figure = Figure(figsize=(10, 5), layout="constrained")
    for axes, values, true, symbol in zip(figure.subplots(2, 3).flat, points.T, truth, symbols, strict=False):
        axes.plot(values, ".", markersize=2)
        axes.axhline(true, color="black", linewidth=0.8)
        axes.set_title(symbol)
        axes.set_xlabel("evaluation")
    figure.savefig(path, dpi=110)


def plot_start(path: Path, seconds: Array, measured: Array, modelled: Array, speed_rpm: Array) -> None:
    """Clarke currents (2, n), measured and modelled, their squared distance and the modelled speed (n,)."""
    figure = Figure(figsize=(9, 8), layout="constrained")
    alpha, beta, distance, speed = figure.subplots(4, 1, sharex=True)
    for axes, ours, theirs, name in zip((alpha, beta), modelled, measured, ("alpha", "beta"), strict=True):
        axes.plot(seconds, theirs, linewidth=1.6, color="0.6", label="measured")
        axes.plot(seconds, ours, linewidth=0.7, color="C0", label="modelled")
        axes.set_ylabel(f"i_{name}, A")
    alpha.legend(fontsize=8)
    distance.semilogy(seconds, ((measured - modelled) ** 2).sum(axis=0) + 1e-12, linewidth=0.7)
    distance.set_ylabel("squared residual, A²")
    speed.plot(seconds, speed_rpm)
    speed.set_ylabel("speed, rpm")
    speed.set_xlabel("time after switching on, s")
    figure.savefig(path, dpi=110)


def plot_errors(path: Path, wrong: Mapping[float, Array], symbols: Sequence[str]) -> None:
    """Relative errors of each parameter over the load, one dot a record."""
    figure = Figure(figsize=(11, 3), layout="constrained")
    for column, (axes, symbol) in enumerate(zip(figure.subplots(1, len(symbols)), symbols, strict=True)):
        for load, values in wrong.items():
            axes.plot(
                np.full(len(values), 100 * load), 100 * values[:, column], ".", color="C0", markersize=3
            )
        axes.axhline(0.0, color="black", linewidth=0.8)
        axes.set_title(symbol)
        axes.set_xlabel("load, %")
    figure.axes[0].set_ylabel("error, %")
    figure.savefig(path, dpi=110)


def plot_intervals(path: Path, widths: Mapping[str, Sequence[float]], symbols: Sequence[str]) -> None:
    """Half widths of the intervals by window; a fixed parameter has none."""
    figure = Figure(figsize=(7, 3), layout="constrained")
    axes = figure.subplots()
    places = np.arange(len(symbols))
    for number, (window, values) in enumerate(widths.items()):
        axes.bar(places + 0.27 * (number - 1), 100 * np.array(values), width=0.25, label=window)
    axes.set_xticks(places, symbols)
    axes.set_yscale("log")
    axes.set_ylabel("half of the 95 % interval, %")
    axes.legend(title="a parameter without a bar is fixed", fontsize=8, title_fontsize=8)
    figure.savefig(path, dpi=110)
