"""Run a gateway as a process of its own, with a session for every relay it holds a lease of.

It is started by the service, which hands it the plant, gives it the settings as a line of JSON on standard
input, and keeps that pipe open. When the pipe closes the service is gone, however it went, and the gateway
ends with it.
"""

import os
import socket
import sys
from threading import Event
from typing import BinaryIO, NoReturn

import structlog

from mms import filter_tls_log_from_stderr
from service.collector.gateway.gateway import Gateway, GatewayIdentity
from service.collector.session.visit_marks import VisitMarks
from service.configuration.settings import Settings
from service.plant import Plant
from service.plant.handover import plant_from_bytes
from service.process.installation import installation_id
from service.process.open_files import allow_open_files
from service.process.single_instance import exclusive
from service.recording_store.opening import open_store
from service.storage import Repository, connect
from service.storage.transaction_limits import limits_of
from service.supervision.child import begin_child

log = structlog.get_logger(__name__)

LEASES_EXPIRED = 3
"""Exit code of a gateway that could not renew its leases."""

OPEN_FILES = 4096
"""Room for the sockets of most relays: each is held by the MMS library, below 1024, and by us, above."""


def gateway_id(settings: Settings, number: int) -> str:
    """Return the id of one of the gateways of an installation."""
    return f"{installation_id(settings.data_directory)}/{number}"


def main(settings_pipe: BinaryIO = sys.stdin.buffer) -> None:
    """Read the settings, collect until the pipe closes, end the process. The argument is its number."""
    child = begin_child("collector", settings_pipe)
    settings, service_gone, plant = child.settings, child.parent_gone, plant_from_bytes(child.handed)
    del child  # with the bytes of the plant
    number = int(sys.argv[1])
    if any(access.tls is not None for access in settings.relays.values()):
        filter_tls_log_from_stderr()
    allow_open_files(OPEN_FILES)
    # The same gateway of a killed service may be about to end: holding its lock, we know that it is dead.
    with exclusive(settings.data_directory / f"gateway-{number}.lock", wait=True):
        left_over = _collect(settings, plant, number, service_gone)
        if left_over:
            # A thread inside the C library must neither keep the process nor see it torn down around itself.
            log.warning("ended with requests under way", sessions=left_over)
            os._exit(0)


def _collect(settings: Settings, plant: Plant, number: int, stop: Event) -> list[str]:
    """Visit relays until `stop` is set. Returns the names of the threads that did not end in time."""
    name = gateway_id(settings, number)
    store = open_store(settings, name.replace("/", "-"))
    store.discard_incoming()
    marks = VisitMarks.of_gateway(settings.data_directory, number)
    marks.clear()  # left by a gateway whose service ended with it
    gateway = Gateway(
        GatewayIdentity(name, socket.gethostname(), os.getpid()),
        plant,
        Repository(connect(settings.database_url, limits=limits_of(settings))),
        store,
        settings,
        visit_marks=marks,
        on_expiry=_end_process,
    )
    log.info("collecting", gateway=number)
    return gateway.run(stop)


def _end_process() -> NoReturn:
    """End this process at once, whatever its threads are doing."""
    log.error("the leases could not be renewed: ending before others take the relays over")
    os._exit(LEASES_EXPIRED)
