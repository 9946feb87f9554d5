"""What one cause in one place adds to a record's figures, by its size."""

from collections.abc import Callable
from dataclasses import dataclass

from core.diagnosis.causes import Cause
from core.machines.base import Array


@dataclass(frozen=True, slots=True)
class Signature:
    """What one cause in one place adds to the figures of a record.

    Parameters
    ----------
    cause : Cause
        The cause.
    place : str
        Phase, winding or channel, in words; empty where it has none.
    columns : ndarray, shape (n, k)
        Added per size, and per size in other directions.
    spread : ndarray, shape (k,)
        Usual sizes.
    one_sided : bool
        Whether the first size is positive.
    share : float
        Share of this place in its cause.
    size_in_words : callable
        Returns size and standard deviation in words.
    """

    cause: Cause
    place: str
    columns: Array
    spread: Array
    one_sided: bool
    share: float
    size_in_words: Callable[[float, float], str]
