"""All that a follower keeps of a motor in one direction of rotation."""

from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from core.condition.filter.state import (
    CANDIDATE,
    CANDIDATES,
    CIRCLE,
    FILTER,
    RECENT,
    RECENT_RECORD,
    SIDE,
    SIDES,
    FilterState,
)
from core.condition.following.header import Header
from core.condition.measuring.parameter_fit import PARAMETER_FIT
from core.signals.sequence import PhaseSequence


class DirectionState:
    """Words and numbers of one direction of rotation, as they are saved.

    Parameters
    ----------
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.

    Attributes
    ----------
    header : Header
        Words and whole numbers.
    filters : array of FilterState, shape (1,)
        The filter, as compiled code takes it.
    filter : FilterState
        The same memory, with its fields as attributes.
    figures : FilterState
        The same memory: a number is read faster by its name, `figures["records"]`.
    bank : array of Candidate
        Candidates.
    sides : array of SideState
        Side channels.
    circles : array of CircleState, shape (1,)
        Filter of the current beside its circle.
    recent : array of Recent
        Latest records.
    parameter_fits : array of PARAMETER_FIT, shape (1,)
        What the records tell of the parameters in the motor's file.
    later : DirectionState or None
        While a change is open, the same with this change in its standing errors: what sees a second one.
    """

    def __init__(self, sequence: PhaseSequence) -> None:
        self.sequence = sequence
        self.header = Header()
        self.filters: Any = np.zeros(1, FILTER)
        self.filter = cast(FilterState, self.filters.view(np.recarray)[0])
        self.figures: Any = self.filters[0]
        self.bank: Any = np.zeros(CANDIDATES, CANDIDATE)
        self.sides: Any = np.zeros(SIDES, SIDE)
        self.circles: Any = np.zeros(1, CIRCLE)
        self.recent: Any = np.zeros(RECENT, RECENT_RECORD)
        self.parameter_fits: Any = np.zeros(1, PARAMETER_FIT)
        self.later: DirectionState | None = None

    def packed(self) -> tuple[dict[str, Any], bytes]:
        """Return the state as a header of text and numbers as they lie in memory.

        Returns
        -------
        header : dict of str to object
            Words and whole numbers.
        body : bytes
            Numbers.
        """
        words, body = self.header.as_dict(), b"".join(array.tobytes() for array in self.arrays)
        if self.later is None:
            return words | {"later": None}, body
        later, more = self.later.packed()
        return words | {"later": later}, body + more

    @classmethod
    def unpacked(cls, sequence: PhaseSequence, words: Mapping[str, Any], body: bytes) -> "DirectionState":
        """Return the state that was packed.

        Parameters
        ----------
        sequence : PhaseSequence
            Order of the supply's phases at the terminals.
        words : mapping
            Header of `packed`.
        body : bytes
            Body of `packed`.

        Returns
        -------
        DirectionState
            The same state.

        Raises
        ------
        ValueError
            If the body is of another length.
        """
        state = cls(sequence)
        later, size = words["later"], sum(array.nbytes for array in state.arrays)
        if len(body) < size or (later is None and len(body) > size):
            raise ValueError("the saved state has another layout: fold the records again")
        if later is not None:
            state.later = cls.unpacked(sequence, later, body[size:])
        start = 0
        for array in state.arrays:
            array[:] = np.frombuffer(body, array.dtype, count=array.size, offset=start)
            start += array.nbytes
        state.header = Header.from_dict(words)
        return state

    def copy(self) -> "DirectionState":
        """Return another state with the same words and numbers.

        Returns
        -------
        DirectionState
            The copy.
        """
        return DirectionState.unpacked(self.sequence, *self.packed())

    def take(self, later: "DirectionState") -> None:
        """Go on with the numbers of another state.

        Parameters
        ----------
        later : DirectionState
            The other state.
        """
        for mine, other in zip(self.arrays, later.arrays, strict=True):
            mine[:] = other

    @property
    def arrays(self) -> tuple[Any, ...]:
        """All numbers."""
        return self.filters, self.sides, self.circles, self.bank, self.recent, self.parameter_fits
