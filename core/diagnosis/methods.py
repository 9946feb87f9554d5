"""Names of the search methods and of the fault models, the same in programs, files and tables."""

from enum import StrEnum

from core.machines.model_names import Model

__all__ = ["DEFAULT_METHOD", "DEFAULT_MODEL", "Method", "Model"]


class Method(StrEnum):
    """How the fault is searched before the local refinement, which follows every method.

    HYBRID is the thesis's algorithm with few points, just enough for the refinement to start in the right
    valley; HCPA is the same algorithm with as many points as the thesis spends.
    """

    HYBRID = "hybrid"
    HCPA = "hcpa"
    GENETIC = "genetic"
    PATTERN_SEARCH = "pattern-search"
    PATTERN_SEARCH_LHS = "pattern-search-lhs"


DEFAULT_METHOD = Method.HYBRID
DEFAULT_MODEL = Model.SPLIT_WINDING
