"""Thesis section 4.4: HCPA on nine test functions beside the thesis's figures; plots like Figs. 4.8-4.13."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult

from benchmarks.optimisers import clusters, multistart
from benchmarks.optimisers.multistart import Refinement
from benchmarks.optimisers.test_functions import TestFunction, by_name
from benchmarks.reporting import table
from benchmarks.thesis.plots import contour
from core.optimisers import hcpa

Array = NDArray[np.float64]
DEEP = 40
"""Fineness for what HCPA can do where the printed one stops it."""
GOOD = 1e-4


@dataclass(frozen=True, slots=True)
class Printed:
    """What the thesis prints: minimum, its point as printed, evaluations (max_global, max_local) and L0."""

    function: str
    minimum: float
    point: tuple[str, ...]
    max_global: int = 500
    max_local: int = 500
    evaluations: str = ""


PRINTED = (
    Printed("Goldstein-Price", 3.0, ("0", "-1")),
    Printed("Rastrigin", 0.0, ("0", "0")),
    Printed("Rosenbrock", 0.2474, ("0.5047", "0.2502")),
    Printed("Rosenbrock", 0.0178, ("0.8667", "0.7510"), 1500, 1500),
    Printed("Rosenbrock", 0.0155, ("1.1245", "1.2646"), 2000, 2000),
    Printed("Branin", 0.3979, ("9.4228", "2.4733")),
    Printed("Himmelblau", 0.0, (), evaluations="not said"),
    Printed("Mladineo", 0.000231, ("0.015771", "0.010514"), 19_500, 500, evaluations="20000"),
    Printed("Hartman 3", -3.8628, ("0.1146", "0.5556", "0.8525"), evaluations="609"),
    Printed("Shekel 5", -10.1532, ("3.9999", "4.0002", "3.9999", "4.0002")),
    Printed("Shekel 7", -10.4029, ("4.0005", "4.0005", "3.9996", "3.9996")),
    Printed("Shekel 10", -10.5364, ("4.0009", "4.0005", "3.9996", "3.9996")),
    Printed("Griewank 10", 2.2352e-7, ("0.00006104",) * 10),
)


def least_level(printed: Printed) -> int:
    """The least level a dyadic point can have that prints as the thesis's does; from the digits alone."""
    function = by_name(printed.function)
    total = 0
    for text, (low, high) in zip(printed.point, function.bounds, strict=True):
        half_digit = 0.5 * 10.0 ** -(len(text.partition(".")[2]))
        first, last = ((float(text) + sign * half_digit - low) / (high - low) - 0.5 for sign in (-1, 1))
        depth = 0
        while np.ceil(first * 2.0**depth) > np.floor(last * 2.0**depth):
            depth += 1
        total += depth
    return total


def lines(images: Path) -> Iterator[str]:
    """The section's lines; plots go into the folder."""
    yield "HCPA with Table 4.1's parameters and as many evaluations as the thesis allows (500 global and 500"
    yield "local unless said otherwise), in the thesis's boxes. `needs level`: the least level of any dyadic"
    yield "point that prints as the thesis's; HCPA only evaluates levels below L0. `deep`: the same"
    yield f"evaluations with fineness {DEEP}, no exclusion. `multistart`: HCPA, then local refinement."
    yield ""
    rows = [_row(printed) for printed in PRINTED]
    yield from table(
        [
            "function", "evaluations allowed", "thesis: minimum at", "needs level", "L0",
            "HCPA: minimum at", "evaluations", "deep", "multistart, evaluations", "true minimum",
        ],
        rows,
    )  # fmt: skip
    yield ""
    yield from _remarks()
    yield ""
    yield "Several global minima (section 4.4.4): 1,000 points at alpha 0.8, fuzzy c-means, Nelder-Mead from"
    yield "each centre."
    yield ""
    header = ["function", "clusters", "minima found", "evaluations"]
    yield from table(header, [_clustered(*one) for one in MULTIPLE])
    yield ""
    yield from _plots(images)


MULTIPLE = (("Branin", 3), ("Himmelblau", 4))


def _run(printed: Printed, *, adaptiveness: float | None = None, deep: bool = False) -> OptimizeResult:
    function = by_name(printed.function)
    return hcpa.minimise(
        function.fun, function.bounds, adaptiveness=adaptiveness, fineness=DEEP if deep else None,
        exclusion=0.0 if deep else None, max_global=printed.max_global, max_local=printed.max_local,
        batch=True,
    )  # fmt: skip


def _row(printed: Printed) -> list[str]:
    function = by_name(printed.function)
    ours = _run(printed)
    deep = _run(printed, deep=True)
    best = _multistart(printed)
    dimensions = len(function.bounds)
    fineness = hcpa.RECOMMENDED.get(dimensions, hcpa.RECOMMENDED_BEYOND)[0]
    at = f"{printed.minimum:g}" + (f" at ({_shortened(printed.point)})" if printed.point else "")
    return [
        function.name,
        printed.evaluations or f"{printed.max_global} + {printed.max_local}",
        at,
        str(least_level(printed)) if printed.point else "",
        str(fineness),
        f"{ours.fun:.6g} at ({_shortened([f'{x:.5g}' for x in ours.x])})",
        str(ours.nfev),
        f"{deep.fun:.6g}",
        f"{best.fun:.6g}, {best.nfev}",
        f"{function.minimum:.6g}",
    ]


def _multistart(printed: Printed) -> OptimizeResult:
    function = by_name(printed.function)
    budget = printed.max_global + printed.max_local
    return multistart.minimise(
        function.fun, function.bounds, max_evaluations=budget, refinement=Refinement(rounds=2), batch=True
    )


def _shortened(texts: tuple[str, ...] | list[str]) -> str:
    shown = ", ".join(texts[:4])
    return shown if len(texts) <= 4 else shown + ", ..."


def _remarks() -> Iterator[str]:
    """What the printed algorithm cannot have given, found from the printed digits."""
    impossible = []
    for printed in PRINTED:
        if printed.point:
            fineness = hcpa.RECOMMENDED.get(len(printed.point), hcpa.RECOMMENDED_BEYOND)[0]
            if least_level(printed) >= fineness:
                impossible.append(printed.function)
    yield f"The thesis's points of {', '.join(dict.fromkeys(impossible))}"
    yield "lie on levels that Table 4.1's L0 excludes: the algorithm as printed cannot have evaluated them,"
    yield "whatever its budget. Its program must have bounded something else than the sum of the coordinates'"
    yield "levels; the figures for Rosenbrock are near those of `deep`. The cross points of level 5"
    every = hcpa.minimise(lambda x: float(x @ x), [(-0.5, 0.5)] * 2, fineness=6, exclusion=0.0)
    yield f"in two dimensions are {every.nfev}, not the 147 of Fig. 4.5."
    for terms in (5, 7, 10):
        printed = next(one for one in PRINTED if one.function == f"Shekel {terms}")
        function = by_name(printed.function)
        deep, best = _run(printed, deep=True), _multistart(printed)
        reached = [
            name
            for name, found in (("HCPA, deep", deep), ("multistart", best))
            if found.fun - function.minimum < GOOD / 2
        ]
        reaching = " and ".join(reached) or "neither"
        yield f"{function.name} to four digits within 1,000 evaluations: {reaching}."


def _clustered(name: str, count: int) -> list[str]:
    function = by_name(name)
    found = clusters.minimise(function.fun, function.bounds, clusters=count, batch=True)
    minima = "; ".join(
        f"{value:.6f} at ({point[0]:.5f}, {point[1]:.5f})"
        for point, value in zip(found.minimisers, found.minima, strict=True)
    )
    return [name, str(count), minima, str(found.nfev)]


def _plots(images: Path) -> Iterator[str]:
    goldstein, rosenbrock = by_name("Goldstein-Price"), by_name("Rosenbrock")
    panels: dict[str, list[tuple[str, TestFunction, OptimizeResult]]] = {
        "goldstein-price": [
            (f"alpha = {alpha:g}", goldstein, _run(Printed(goldstein.name, 3.0, ()), adaptiveness=alpha))
            for alpha in (1.0, 0.0, 0.5)
        ],
        "rosenbrock": [
            (f"{part} + {part} points", rosenbrock, _run(Printed(rosenbrock.name, 0.0, (), part, part)))
            for part in (500, 1500, 2000)
        ],
    }
    panels["others"] = [
        (name, by_name(name), _run(Printed(name, 0.0, ()))) for name in ("Rastrigin", "Mladineo", "Branin")
    ]
    for name, count in MULTIPLE:
        function = by_name(name)
        found = clusters.minimise(function.fun, function.bounds, clusters=count, batch=True)
        panels[f"clusters-{name.lower()}"] = [(f"{name}: {count} clusters", function, found)]
    captions: dict[str, str] = {
        "goldstein-price": "Goldstein-Price, like Fig. 4.8 (b) to (d)",
        "rosenbrock": "Rosenbrock, like Fig. 4.10",
        "others": "Rastrigin, Mladineo and Branin, like Figs. 4.9, 4.13 and 4.11 (b)",
        "clusters-branin": "Branin in three clusters, like Fig. 4.11 (d)",
        "clusters-himmelblau": "Himmelblau in four clusters, like Fig. 4.12",
    }
    for stem, shown in panels.items():
        contour(images / f"functions-{stem}.png", shown)
        yield f"![{captions[stem]}](images/thesis/functions-{stem}.png)"
        yield ""
