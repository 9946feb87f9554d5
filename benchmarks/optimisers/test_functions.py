"""The nine test functions of thesis section 4.4, with their signs put right.

Hartman (4.13) and Shekel (4.14) are printed without the minus signs that make them the functions whose
minima are quoted, and Rastrigin (4.8) without the constant that makes its minimum 0. Sources: Dixon and
Szegö, Towards Global Optimisation 2, 1978; Jamil and Yang, Int. J. Math. Model. Numer. Optim. 4 (2013),
doi:10.1504/IJMMNO.2013.055204. Minima are given to the digits of a double, from Newton's method.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.optimisers.objective import Array


@dataclass(frozen=True, slots=True)
class TestFunction:
    """A function of points (m, d), the box it is searched in, its least value and where that is, (k, d)."""

    __test__ = False

    name: str
    fun: Callable[[Array], Array]
    bounds: tuple[tuple[float, float], ...]
    minimum: float
    minimisers: Array


def goldstein_price(points: Array) -> Array:
    """(4.7)."""
    x, y = points.T
    first = 1 + (x + y + 1) ** 2 * (19 - 14 * x + 3 * x**2 - 14 * y + 6 * x * y + 3 * y**2)
    second = 30 + (2 * x - 3 * y) ** 2 * (18 - 32 * x + 12 * x**2 + 48 * y - 36 * x * y + 27 * y**2)
    return np.asarray(first * second)


def rastrigin(points: Array) -> Array:
    """(4.8), raised by its number of dimensions so that its minimum is the 0 the thesis gives."""
    return np.asarray((points**2 - np.cos(18.0 * points) + 1.0).sum(axis=1))


def rosenbrock(points: Array) -> Array:
    """(4.9)."""
    x, y = points.T
    return np.asarray(100.0 * (y - x**2) ** 2 + (x - 1.0) ** 2)


def branin(points: Array) -> Array:
    """(4.10)."""
    x, y = points.T
    valley = y - 5.1 / (4 * np.pi**2) * x**2 + 5 / np.pi * x - 6
    return np.asarray(10 * (1 - 1 / (8 * np.pi)) * np.cos(x) + valley**2 + 10)


def himmelblau(points: Array) -> Array:
    """(4.11)."""
    x, y = points.T
    return np.asarray((x**2 + y - 11) ** 2 + (x + y**2 - 7) ** 2)


def mladineo(points: Array) -> Array:
    """(4.12)."""
    orders = np.arange(2, points.shape[1] + 2)
    waves = np.cos(10.0 * np.log(orders * points))
    return np.asarray(1 + (points**2).mean(axis=1) - waves.prod(axis=1))


_HARTMAN_A = np.array([[3, 10, 30], [0.1, 10, 35], [3, 10, 30], [0.1, 10, 35]])
_HARTMAN_B = np.array(
    [[0.3689, 0.1170, 0.2673], [0.4699, 0.4387, 0.7470], [0.1091, 0.8732, 0.5547], [0.03815, 0.5743, 0.8828]]
)
_HARTMAN_C = np.array([1.0, 1.2, 3.0, 3.2])


def hartman_3(points: Array) -> Array:
    """(4.13) with both minus signs it was printed without: of the sum and of the exponents."""
    squares = (points[:, np.newaxis] - _HARTMAN_B) ** 2
    return np.asarray(-np.exp(-(_HARTMAN_A * squares).sum(axis=2)) @ _HARTMAN_C)


_SHEKEL_A = np.array(
    [
        [4, 4, 4, 4], [1, 1, 1, 1], [8, 8, 8, 8], [6, 6, 6, 6], [3, 7, 3, 7],
        [2, 9, 2, 9], [5, 5, 3, 3], [8, 1, 8, 1], [6, 2, 6, 2], [7, 3.6, 7, 3.6],
    ]
)  # fmt: skip
_SHEKEL_C = np.array([0.1, 0.2, 0.2, 0.4, 0.4, 0.6, 0.3, 0.7, 0.5, 0.5])


def shekel(terms: int) -> Callable[[Array], Array]:
    """(4.14) with the minus sign it was printed without; terms: m, 5, 7 or 10."""

    def fun(points: Array) -> Array:
        squares = ((points[:, np.newaxis] - _SHEKEL_A[:terms]) ** 2).sum(axis=2)
        return np.asarray(-(1.0 / (_SHEKEL_C[:terms] + squares)).sum(axis=1))

    return fun


def simplified_griewank(points: Array) -> Array:
    """(4.15)."""
    return np.asarray(1 + (points**2).mean(axis=1) - np.cos(points).prod(axis=1))


_OF_SHEKEL = {
    5: (-10.153199679058229, (4.0000372, 4.0001333, 4.0000372, 4.0001333)),
    7: (-10.402940566818662, (4.0005729, 4.0006894, 3.9994897, 3.9996062)),
    10: (-10.536409816692041, (4.0007465, 4.0005929, 3.9996634, 3.9995098)),
}

FUNCTIONS = (
    TestFunction("Goldstein-Price", goldstein_price, ((-2.0, 2.0),) * 2, 3.0, np.array([[0.0, -1.0]])),
    TestFunction("Rastrigin", rastrigin, ((-1.0, 1.0),) * 2, 0.0, np.zeros((1, 2))),
    TestFunction("Rosenbrock", rosenbrock, ((-2.0, 3.0), (-2.0, 9.0)), 0.0, np.ones((1, 2))),
    TestFunction(
        "Branin",
        branin,
        ((-5.0, 10.0), (0.0, 15.0)),
        0.39788735772973816,
        np.array([[-np.pi, 12.275], [np.pi, 2.275], [3 * np.pi, 2.475]]),
    ),
    TestFunction(
        "Himmelblau",
        himmelblau,
        ((-5.0, 5.0),) * 2,
        0.0,
        np.array([[3.0, 2.0], [-2.8051181, 3.1313125], [-3.7793103, -3.283186], [3.5844283, -1.8481265]]),
    ),
    TestFunction(
        "Mladineo", mladineo, ((0.01, 1.0),) * 2, 0.00017018301776972056, np.array([[0.01152704, 0.01440461]])
    ),
    TestFunction(
        "Hartman 3",
        hartman_3,
        ((0.0, 1.0),) * 3,
        -3.862782147820755,
        np.array([[0.11461434, 0.55564885, 0.85254695]]),
    ),
    *(
        TestFunction(f"Shekel {terms}", shekel(terms), ((0.0, 10.0),) * 4, minimum, np.array([minimiser]))
        for terms, (minimum, minimiser) in _OF_SHEKEL.items()
    ),
    TestFunction("Griewank 10", simplified_griewank, ((-1.0, 4.0),) * 10, 0.0, np.zeros((1, 10))),
)


def by_name(name: str) -> TestFunction:
    """The test function called `name`; raises KeyError for none."""
    return {one.name: one for one in FUNCTIONS}[name]
