"""Names of the search methods and of the fault models, the same in programs, files and tables."""

from enum import StrEnum

from core.machines.model_names import Model

__all__ = ["DEFAULT_METHOD", "DEFAULT_MODEL", "Method", "Model", "resolved"]


class Method(StrEnum):
    """How the fault is found.

    EVIDENCE searches nothing: it weighs every phase, axis, leakage and level of turns in a coil, and all
    other causes. The searches are the thesis's way to its own models: HYBRID is its algorithm with few
    points, just enough for the refinement to start in the right valley; HCPA is the same with as many points
    as it spends.
    """

    EVIDENCE = "evidence"
    HYBRID = "hybrid"
    HCPA = "hcpa"
    GENETIC = "genetic"
    PATTERN_SEARCH = "pattern-search"
    PATTERN_SEARCH_LHS = "pattern-search-lhs"


DEFAULT_METHOD = Method.EVIDENCE
DEFAULT_MODEL = Model.COIL


def resolved(method: str, model: str) -> tuple[str, str]:
    """Return how a record is diagnosed where only a method or only a model is named.

    Parameters
    ----------
    method : str
        One of `Method`.
    model : str
        One of `Model`.

    Returns
    -------
    method : str
        A search goes with a model of the thesis, the evidence with turns in a coil.
    model : str
        The model that goes with it.
    """
    if model == Model.COIL and method != Method.EVIDENCE:
        return method, Model.SPLIT_WINDING
    if model != Model.COIL and method == Method.EVIDENCE:
        return Method.HYBRID, model
    return method, model
