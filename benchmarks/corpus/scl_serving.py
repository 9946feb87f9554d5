"""Each relay of an SCL file served by ied-sim over MMS, and its names compared with those of the file."""

import logging
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import scl
from benchmarks.corpus.outcomes import Served, Service
from ied_sim.errors import SimulatorError
from ied_sim.simulator import Simulator
from mms import MmsError
from scl import Address, Scl
from testing.ports import LOOPBACK, free_port
from testing.relays.browsing import Contents, contents_at, contents_of_file

ENOUGH_S = 40.0
"""Relays of one file that are still waiting then are not tried: a file has a minute."""
MOST_NAMES = 3
ATTEMPTS = 3


def serve_relays(path: Path) -> tuple[Served, ...]:
    """Serve every relay with a server, one after the other."""
    logging.disable(logging.CRITICAL)  # what is left out is told as a note
    try:
        return tuple(_each(path))
    finally:
        logging.disable(logging.NOTSET)


def _each(path: Path) -> Iterator[Served]:
    document = scl.read(path)
    begun = time.monotonic()
    for ied in document.ieds:
        if not ied.logical_devices:
            continue
        if time.monotonic() - begun > ENOUGH_S:
            yield Served(ied.name, Service.NOT_TRIED, (f"the file took over {ENOUGH_S:g} s",))
            continue
        yield _one(document, ied.name)


def _one(document: Scl, name: str) -> Served:
    try:
        found = _browsed(document, name)
    except (SimulatorError, MmsError) as error:
        return Served(name, Service.NOT_SERVED, (str(error).removeprefix(f"{document.path}: "),))
    try:
        wanted = contents_of_file(document.path, name)
    except (LookupError, ValueError) as error:
        why = f"served; its names are not compared, for the file has an odd one: {error!r}"
        return Served(name, Service.IN_PART, (why,))
    differences = tuple(_differences(wanted, found))
    return Served(name, Service.IN_PART if differences else Service.WHOLE, differences)


def _browsed(document: Scl, name: str) -> Contents:
    """Serve one relay and ask it for all its names; another port is tried where somebody was faster."""
    for attempt in range(1, ATTEMPTS + 1):
        port = free_port()
        with tempfile.TemporaryDirectory(prefix="corpus-") as folder:
            simulator = Simulator(
                document, {}, files=Path(folder), ieds=[name], addresses={name: Address(LOOPBACK, port)}
            )
            try:
                simulator.start()
            except SimulatorError:
                simulator.stop()
                if attempt == ATTEMPTS:
                    raise
                continue
            try:
                return contents_at(LOOPBACK, port)
            finally:
                simulator.stop()
    raise SimulatorError("no free port")


def _differences(wanted: Contents, found: Contents) -> Iterator[str]:
    """What stands in the file and not on the server, and the other way round."""
    of_file = {f"{domain}/{name}" for domain, names in wanted.names.items() for name in names}
    of_server = {f"{domain}/{name}" for domain, names in found.names.items() for name in names}
    for names, words in (
        (of_file - of_server, "not served"),
        (of_server - of_file, "served, not in the file"),
    ):
        if names:
            yield f"{len(names)} names {words}: {', '.join(sorted(names)[:MOST_NAMES])}"
    for data_set, members in wanted.data_sets.items():
        served = found.data_sets.get(data_set, [])
        if lost := [member for member in members if member not in served]:
            yield f"{data_set} without {len(lost)} members: {', '.join(lost[:MOST_NAMES])}"
        elif served != members:
            yield f"{data_set} with other members: {', '.join(served[:MOST_NAMES])}"
