"""What the operator of the demo plant does: a motor is started anew, so that there are recorded starts."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import scl
from mms import Client

RELAY: Final = "A1_SEL710"
STOP: Final = "CON/RBGGIO1.SPCSO04"
START: Final = "CON/RBGGIO1.SPCSO03"

AT_REST_S: Final = 0.5
"""The contactor opens 40 ms after the command."""


def restart(scd: Path, pause: Callable[[float], None], *, relay: str = RELAY) -> None:
    """Stop a relay's motor and start it again. Raises MmsError, SclError."""
    address = scl.read(scd).address(relay)
    with Client.connect(address.host, address.port) as operator:
        for control in (STOP, START):
            for value in (True, False):  # the relay acts when a remote bit rises
                operator.operate(f"{relay}{control}", value=value)
            pause(AT_REST_S)
