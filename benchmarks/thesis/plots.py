"""Plots of the reproduced experiments, small PNG files."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult

from benchmarks.optimisers.test_functions import TestFunction

Array = NDArray[np.float64]
DOTS_PER_INCH = 70
PANEL_INCH = 4.0
mpl.use("Agg")


def contour(path: Path, panels: Sequence[tuple[str, TestFunction, OptimizeResult]]) -> None:
    """Level lines of functions of two variables, the points evaluated, the best (a star), cluster centres."""
    figure = Figure(figsize=(PANEL_INCH * len(panels), PANEL_INCH), dpi=DOTS_PER_INCH, layout="constrained")
    row = figure.subplots(1, len(panels), squeeze=False)[0]
    for axes, (title, function, result) in zip(row, panels, strict=True):
        x, y = (np.linspace(low, high, 160) for low, high in function.bounds)
        grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        values = (function.fun(grid) - function.minimum).reshape(160, 160)
        axes.contour(x, y, np.log10(values + 1e-3 * np.ptp(values)), 14, linewidths=0.5, cmap="Greys_r")
        axes.plot(*result.points.T, ".", color="tab:blue", markersize=2)
        if "centres" in result:
            axes.plot(*result.centres.T, "o", color="tab:orange", markersize=7)
            axes.plot(*result.minimisers.T, "*", color="tab:red", markersize=12)
        else:
            axes.plot(*result.x, "*", color="tab:red", markersize=12)
        axes.set_title(title)
    save(figure, path)


def curves(
    path: Path,
    panels: Sequence[tuple[str, str, str, Sequence[tuple[str, Array, Array]]]],
    *,
    logarithmic: bool = False,
) -> None:
    """Panels (title, x label, y label, curves (label, x, y))."""
    figure = Figure(figsize=(PANEL_INCH * len(panels), PANEL_INCH), dpi=DOTS_PER_INCH, layout="constrained")
    row = figure.subplots(1, len(panels), squeeze=False)[0]
    for axes, (title, x_label, y_label, shown) in zip(row, panels, strict=True):
        for label, x, y in shown:
            axes.plot(x, y, ".-", label=label)
        if logarithmic:
            axes.set_yscale("log")
        axes.set_title(title)
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        axes.legend(fontsize="small")
    save(figure, path)


def scatter(path: Path, panels: Sequence[tuple[str, Array, Array]]) -> None:
    """Panels (title, points (n, 3), best (3,)) of mu_f, theta_f and load in space."""
    figure = Figure(figsize=(PANEL_INCH * len(panels), PANEL_INCH), dpi=DOTS_PER_INCH, layout="constrained")
    for place, (title, points, best) in enumerate(panels, start=1):
        axes = figure.add_subplot(1, len(panels), place, projection="3d")
        axes.plot(*points.T, ".", color="tab:blue", markersize=2)
        axes.plot(*best[:, np.newaxis], "*", color="tab:red", markersize=12)
        axes.set_title(title)
        axes.set_xlabel("mu_f")
        axes.set_ylabel("theta_f")
        axes.set_zlabel("load")
    save(figure, path)


def save(figure: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
