"""A follower's state as bytes: a header of text, then the arrays as they lie in memory."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Final
from zlib import compress, decompress
from zlib import error as zlib_error

from core.condition.events import Event, EventKind
from core.condition.following.direction_state import DirectionState
from core.condition.rules import LAYOUT
from core.signals.sequence import PhaseSequence

MAGIC: Final = b"StatorWatch follower %d\n" % LAYOUT


def pack(directions: Sequence[DirectionState], ended_by: Event | None) -> bytes:
    """Write a state.

    Parameters
    ----------
    directions : sequence of DirectionState
        What was learnt in each direction by each recorder.
    ended_by : Event or None
        The latest event that ended the reference, where there is no record since.

    Returns
    -------
    bytes
        The state.
    """
    headers, bodies = [], []
    for direction in directions:
        header, numbers = direction.packed()
        body = compress(numbers, level=1)
        headers.append({"sequence": str(direction.sequence), "bytes": len(body)} | header)
        bodies.append(body)
    document = {"directions": headers, "ended_by": None if ended_by is None else asdict(ended_by)}
    return MAGIC + json.dumps(document).encode() + b"\n" + b"".join(bodies)


def unpack(state: bytes) -> tuple[list[DirectionState], Event | None]:
    """Read a state.

    Parameters
    ----------
    state : bytes
        What `pack` wrote.

    Returns
    -------
    directions : list of DirectionState
        What was learnt in each direction by each recorder.
    ended_by : Event or None
        The latest event that ended the reference, where there is no record since.

    Raises
    ------
    ValueError
        If it is no state of this version.
    """
    if not state.startswith(MAGIC):
        raise ValueError(
            f"the saved state begins with {state[:24]!r}, expected {MAGIC!r}: fold the records again"
        )
    end = state.find(b"\n", len(MAGIC))
    if end < 0:
        raise ValueError("the saved state ends within its header: fold the records again")
    document = json.loads(state[len(MAGIC) : end])
    start, directions = end + 1, []
    for header in document["directions"]:
        body = state[start : start + header["bytes"]]
        if len(body) != header["bytes"]:
            raise ValueError("the saved state is shorter than its header says: fold the records again")
        sequence = PhaseSequence(header["sequence"])
        try:
            numbers = decompress(body)
        except zlib_error as error:
            raise ValueError(f"the saved state is damaged ({error}): fold the records again") from error
        directions.append(DirectionState.unpacked(sequence, header, numbers))
        start += len(body)
    ended_by = document["ended_by"]
    if ended_by is not None:
        ended_by = Event(ended_by["time_ns"], EventKind(ended_by["kind"]), ended_by["reason"])
    return directions, ended_by
