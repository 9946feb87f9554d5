"""The ports of the demo: those of its SCD, or other free ones where they are taken."""

import socket
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import scl
from scl import Address

LOOPBACK = "127.0.0.1"


def addressed_scd(scd: Path, directory: Path) -> Path:
    """Return the SCD itself if all its ports are free, else a copy in `directory` with free ports.

    Raises SclError, OSError.
    """
    document = scl.read(scd)
    addresses = {ied.name: document.address(ied.name) for ied in document.ieds}
    if all(is_free(address.port) for address in addresses.values()):
        return scd
    copy = directory / scd.name
    ports = free_ports(len(addresses))
    others = {name: Address(LOOPBACK, port) for name, port in zip(addresses, ports, strict=True)}
    scl.with_addresses(scd, copy, others)
    return copy


def free_port(wanted: int) -> int:
    """Return the wanted port of the loopback interface if it is free, else another."""
    return wanted if is_free(wanted) else free_ports(1)[0]


def is_free(port: int) -> bool:
    """Whether a server could listen on a port of the loopback interface now."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port))
        except OSError:
            return False
    return True


def free_ports(count: int) -> Sequence[int]:
    """Return different free ports of the loopback interface."""
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for probe in sockets:
            probe.bind((LOOPBACK, 0))
        return [probe.getsockname()[1] for probe in sockets]
