"""A follower's state as bytes: a header of text, then the arrays as they lie in memory."""

import json
from collections.abc import Mapping
from typing import Final

from core.condition.following.direction import Direction
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence

MAGIC: Final = b"StatorWatch follower 1\n"
"""Name and version; another layout gets another number."""


def pack(latest: PhaseSequence | None, directions: Mapping[PhaseSequence, Direction]) -> bytes:
    """Write a state.

    Parameters
    ----------
    latest : PhaseSequence or None
        Sequence of the latest record.
    directions : mapping of PhaseSequence to Direction
        What was learnt in each direction.

    Returns
    -------
    bytes
        The state.
    """
    headers, bodies = [], []
    for sequence in sorted(directions):
        header, body = directions[sequence].packed()
        headers.append({"sequence": str(sequence), "bytes": len(body)} | header)
        bodies.append(body)
    text = json.dumps({"latest": None if latest is None else str(latest), "directions": headers})
    return MAGIC + text.encode() + b"\n" + b"".join(bodies)


def unpack(motor: Motor, state: bytes) -> tuple[PhaseSequence | None, dict[PhaseSequence, Direction]]:
    """Read a state.

    Parameters
    ----------
    motor : Motor
        The motor.
    state : bytes
        What `pack` wrote.

    Returns
    -------
    latest : PhaseSequence or None
        Sequence of the latest record.
    directions : dict of PhaseSequence to Direction
        What was learnt in each direction.

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
    start, directions = end + 1, {}
    for header in document["directions"]:
        body = state[start : start + header["bytes"]]
        if len(body) != header["bytes"]:
            raise ValueError("the saved state is shorter than its header says: fold the records again")
        sequence = PhaseSequence(header["sequence"])
        directions[sequence] = Direction.unpacked(motor, sequence, header, body)
        start += len(body)
    latest = document["latest"]
    return None if latest is None else PhaseSequence(latest), directions
