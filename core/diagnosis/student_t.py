"""Quantiles of Student's t distribution, for intervals from few cycles."""

from math import atan, cos, exp, lgamma, log, pi, sin, sqrt
from statistics import NormalDist


def student_t_quantile(probability: float, degrees_of_freedom: int) -> float:
    """Return the value that a t-distributed variable stays below with the given probability.

    It equals `scipy.stats.t.ppf`, which is not used because the import of scipy.stats, and of scipy.special
    alone, takes longer than a whole diagnosis.

    References
    ----------
    Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.3 and 26.7.4.
    """
    t = NormalDist().inv_cdf(probability)
    while True:
        # The distribution function is concave above its median, so Newton's method converges from below.
        ahead = (probability - _below(t, degrees_of_freedom)) / _density(t, degrees_of_freedom)
        if not t + ahead > t * (1.0 + 1e-14):
            return t
        t += ahead


def _density(t: float, nu: int) -> float:
    half = lgamma((nu + 1) / 2.0) - lgamma(nu / 2.0)
    return exp(half - (nu + 1) / 2.0 * log(1.0 + t * t / nu)) / sqrt(nu * pi)


def _below(t: float, nu: int) -> float:
    """Distribution function at t > 0."""
    angle = atan(t / sqrt(nu))
    odd = nu % 2
    term = cos(angle) if odd else 1.0
    total = 0.0
    for k in range(2 + odd, nu + 1, 2):
        total += term
        term *= (k - 1) / k * cos(angle) ** 2
    within = 2.0 / pi * (angle + sin(angle) * total) if odd else sin(angle) * total
    return 0.5 + within / 2.0
