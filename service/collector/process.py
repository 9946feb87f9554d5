"""The collector process: a session for every relay, and a watch on the database for wishes.

It is started by the service, which hands it the settings as one line of JSON on standard input and keeps that
pipe open. When the pipe closes the service is gone, however it went, and the collector ends with it.
"""

import os
import signal
import sys
import time
from threading import Event, Thread
from typing import BinaryIO

import structlog

from service.collector.relay_session import RelaySession
from service.exclusive import exclusive
from service.logs import configure_logging
from service.plant import read_plant
from service.recordings import RecordingStore
from service.settings import Settings
from service.storage import Repository, connect

log = structlog.get_logger(__name__)

WISH_PERIOD_S = 0.2
"""Between looks into the database for event reports somebody asked for."""

STOP_PATIENCE_S = 2.0
"""A session may be inside a request that lasts up to its time limit; nothing is lost by leaving it there."""


def main(settings_pipe: BinaryIO = sys.stdin.buffer) -> None:
    """Read the settings, collect until the pipe closes, end the process."""
    # Ctrl-C reaches every process of the terminal; this one ends when the service says so.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    settings = Settings.model_validate_json(settings_pipe.readline())
    configure_logging("collector")
    service_gone = Event()
    Thread(target=_watch, args=(settings_pipe, service_gone), name="parent-watch", daemon=True).start()
    # The collector of a killed service may be about to end: two at once would trigger twice.
    with exclusive(settings.data_directory / "collector.lock", wait=True):
        left_over = collect(settings, service_gone)
        if left_over:
            # A thread inside the C library must neither keep the process nor see it torn down around itself.
            log.warning("ended with requests under way", sessions=left_over)
            os._exit(0)


def collect(settings: Settings, stop: Event) -> list[str]:
    """Run the sessions of all relays until `stop` is set. Returns those that did not end in time."""
    plant = read_plant(settings)
    repository = Repository(connect(settings.database_url))
    store = RecordingStore(settings.recordings_directory)
    sessions = {
        relay.name: RelaySession(relay, plant.motor_of(relay.name).name, repository, store, settings)
        for relay in plant.relays
    }
    threads = [
        Thread(target=session.run, name=f"relay-{name}", daemon=True) for name, session in sessions.items()
    ]
    for thread in threads:
        thread.start()
    log.info("collecting", relays=len(sessions))
    while not stop.wait(WISH_PERIOD_S):
        for ied in repository.ieds_with_requests():
            if ied in sessions:
                sessions[ied].wake()
    for session in sessions.values():
        session.stop()
    deadline_s = time.monotonic() + STOP_PATIENCE_S
    for thread in threads:
        thread.join(max(0.0, deadline_s - time.monotonic()))
    return [thread.name for thread in threads if thread.is_alive()]


def _watch(pipe: BinaryIO, service_gone: Event) -> None:
    pipe.read()
    service_gone.set()
