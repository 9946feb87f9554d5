"""Find a minimum with the Hyperbolic Cross Point Algorithm: python examples/search_a_function.py"""

import numpy as np
from numpy.typing import NDArray

from core.optimisers import hcpa


def himmelblau(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Four minima, all zero; takes points (m, 2) at once."""
    x, y = points.T
    return np.asarray((x**2 + y - 11) ** 2 + (x + y**2 - 7) ** 2, dtype=np.float64)


def main() -> None:
    result = hcpa.minimise(himmelblau, [(-6, 6), (-6, 6)], fineness=24, batch=True)
    print(f"{result.fun:.2e} at {result.x} after {result.nfev} evaluations: {result.message}")


if __name__ == "__main__":
    main()
