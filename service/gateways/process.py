"""Run one gateway as a process of its own: `python -m service.gateways KIND`, started by the service.

What does not work in it goes to the service as lines of JSON on the standard output.
"""

import json
import os
import sys
from collections.abc import Callable, Collection, Mapping
from typing import BinaryIO

import structlog

from service.gateways.context import GatewayContext
from service.process.capabilities import Capability
from service.storage import Repository, connect
from service.storage.transaction_limits import limits_of
from service.supervision.child import begin_child

log = structlog.get_logger(__name__)

Run = Callable[[GatewayContext], None]


def _goose() -> Run:
    from service.gateways.goose.gateway import run

    return run


def _iec104() -> Run:
    from service.gateways.iec104.gateway import run

    return run


def _iec61850() -> Run:
    from service.gateways.iec61850.gateway import run

    return run


def _modbus() -> Run:
    from service.gateways.modbus.gateway import run

    return run


def _mqtt() -> Run:
    from service.gateways.mqtt.gateway import run

    return run


def _opcua() -> Run:
    from service.gateways.opcua.gateway import run

    return run


KINDS: Mapping[str, Callable[[], Run]] = {
    "goose": _goose,
    "iec104": _iec104,
    "iec61850": _iec61850,
    "modbus": _modbus,
    "mqtt": _mqtt,
    "opcua": _opcua,
}
"""Each loads its gateway, with its library, in its own process alone."""

NEEDED: Mapping[str, Collection[Capability]] = {
    "goose": [Capability.NET_RAW],
    "iec104": [Capability.NET_BIND_SERVICE],
    "iec61850": [Capability.NET_BIND_SERVICE],
    "modbus": [Capability.NET_BIND_SERVICE],
    "opcua": [Capability.NET_BIND_SERVICE],
}
"""Capabilities that kinds keep: to hear Ethernet frames, and to listen at ports such as 102 and 502."""


def main() -> None:
    """Run the gateway that the command line names until the service is gone."""
    kind = sys.argv[1]
    child = begin_child(f"gateway {kind}", needs=NEEDED.get(kind, ()))
    settings = child.settings
    with _private_output() as output:
        repository = Repository(connect(settings.database_url, limits=limits_of(settings)))
        try:
            KINDS[kind]()(GatewayContext(settings, repository, child.parent_gone, ProblemTeller(output)))
        except Exception:  # the service starts it again
            log.exception("the gateway failed")
            # Python would wait for the thread that reads the service's pipe, and abort.
            os._exit(1)


def _private_output() -> BinaryIO:
    """Return the standard output, and let what libraries print there go to the standard error."""
    output = os.dup(sys.stdout.fileno())
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return os.fdopen(output, "wb", buffering=0)


class ProblemTeller:
    """Writes a line where another problem is told than before."""

    def __init__(self, output: BinaryIO) -> None:
        self._output = output
        self._told: str | None = ""

    def __call__(self, problem: str | None) -> None:
        """Tell what does not work; None where all does."""
        if problem != self._told:
            self._told = problem
            self._output.write(json.dumps({"problem": problem}).encode() + b"\n")
