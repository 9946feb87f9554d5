"""The SCL files of a simulated plant: one SCD, or the CIDs of its relays, read as one."""

import logging
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import scl
from ied_sim.errors import SimulatorError
from scl import Address, Scl

MOST_WARNINGS = 20
HIGHEST_PORT = 65535

log = logging.getLogger(__name__)


def read_plant(paths: Sequence[Path]) -> Scl:
    """Read the files as one, and log what is left out of them: an IED of a name that another file has, say.

    Raises SclError where a file cannot be read.
    """
    plant, *others = [_read(path) for path in paths]
    for document in others:
        taken = {ied.name for ied in plant.ieds}
        for ied in document.ieds:
            if ied.name in taken:
                log.warning(
                    "%s: %s is not served: another file has an IED of this name", document.path.name, ied.name
                )
        added = tuple(ied for ied in document.ieds if ied.name not in taken)
        plant = replace(
            plant,
            path=Path(f"{plant.path}, {document.path}"),
            ieds=plant.ieds + added,
            communication=plant.communication + document.communication,
        )
    return plant


def consecutive_addresses(document: Scl, names: Sequence[str], host: str, port: int) -> dict[str, Address]:
    """Return an address for each relay with a server: one port after the other.

    Raises SclError for an unknown IED, SimulatorError where there are not so many ports.
    """
    serving = [name for name in dict.fromkeys(names) if document.ied(name).logical_devices]
    if port + len(serving) - 1 > HIGHEST_PORT:
        raise SimulatorError(
            f"{len(serving)} relays from port {port} on: there are only {HIGHEST_PORT} ports"
        )
    return {name: Address(host, port + number) for number, name in enumerate(serving)}


def _read(path: Path) -> Scl:
    document = scl.read(path)
    left_out = [warning for warning in document.warnings if warning.left_out]
    for warning in left_out[:MOST_WARNINGS]:
        log.warning("%s: %s", path.name, warning)
    if more := left_out[MOST_WARNINGS:]:
        log.warning("%s: %d more are left out: mcc import-scl lists them", path.name, len(more))
    return document
