"""A follower's state as bytes: a header of text, then the arrays as they lie in memory."""

import json
from collections.abc import Sequence
from typing import Final
from zlib import compress, decompress
from zlib import error as zlib_error

from core.condition.following.direction import Direction
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence

MAGIC: Final = b"StatorWatch follower 4\n"
"""Name and version; another layout gets another number."""


def pack(directions: Sequence[Direction]) -> bytes:
    """Write a state.

    Parameters
    ----------
    directions : sequence of Direction
        What was learnt in each direction by each recorder.

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
    return MAGIC + json.dumps({"directions": headers}).encode() + b"\n" + b"".join(bodies)


def unpack(motor: Motor, state: bytes) -> list[Direction]:
    """Read a state.

    Parameters
    ----------
    motor : Motor
        The motor.
    state : bytes
        What `pack` wrote.

    Returns
    -------
    list of Direction
        What was learnt in each direction by each recorder.

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
        directions.append(Direction.unpacked(motor, sequence, header, numbers))
        start += len(body)
    return directions
