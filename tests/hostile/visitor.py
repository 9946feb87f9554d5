"""A client process that asks a hostile relay everything, again and again; arguments: port, seed, directory.

Errors of MMS are what is expected. Whatever else is raised is told on standard output, one line each.
"""

import os
import queue
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from random import Random

from mms import (
    Client,
    ClientLimits,
    ConnectFailed,
    ConnectionLost,
    FunctionalConstraint,
    MmsError,
    Report,
)
from service.collector.records.listing import FolderListing, understand
from service.collector.records.pull import pull
from service.recording_store.errors import RecordingStoreError
from service.recording_store.folder import FolderStore
from testing.ports import LOOPBACK
from tests.hostile.dialogue import CON, PRO

REQUEST_TIMEOUT_S = 0.06
LIMITS = ClientLimits(command_termination_s=0.05, loss_notice_s=0.02)
REQUESTS_A_CONNECTION = 60
MAX_FILE_BYTES = 1_000_000


STATES = tuple(f"{PRO}/GGIO1.Ind0{number}.stVal" for number in (1, 2, 3, 4))


class Visitor:
    """Asks at random; a record's files go to a real store."""

    def __init__(self, port: int, seed: str, directory: Path) -> None:
        self._port = port
        self._chance = Random(seed)
        self._store = FolderStore(directory / "recordings")
        self._reports: queue.SimpleQueue[Report] = queue.SimpleQueue()

    def visit(self) -> None:
        """One association. Raises MmsError."""
        with Client.connect(
            LOOPBACK,
            self._port,
            connect_timeout_s=0.5,
            request_timeout_s=REQUEST_TIMEOUT_S,
            limits=LIMITS,
        ) as client:
            requests: tuple[Callable[[Client], object], ...] = (
                lambda c: c.logical_nodes(PRO),
                lambda c: c.data_objects(f"{PRO}/GGIO1"),
                lambda c: c.buffered_reports(f"{PRO}/LLN0"),
                lambda c: c.read(f"{PRO}/GGIO1.Types", FunctionalConstraint.ST),
                lambda c: c.read(f"{PRO}/GGIO1.AnIn1", FunctionalConstraint.MX),
                lambda c: c.read_together(STATES, FunctionalConstraint.ST),
                lambda c: c.read_data_set(f"{PRO}/LLN0.DSet01"),
                lambda c: c.operate(f"{CON}/RBGGIO1.SPCSO0{self._chance.randint(1, 4)}", value=True),
                self._subscribe,
                lambda c: c.files("EVENTS"),
                self._pull,
                self._pull,
            )
            for _ in range(REQUESTS_A_CONNECTION):
                try:
                    self._chance.choice(requests)(client)
                except ConnectionLost:
                    return
                except (MmsError, RecordingStoreError):
                    continue
                while not self._reports.empty():
                    self._reports.get()

    def _subscribe(self, client: Client) -> None:
        client.subscribe(
            f"{PRO}/LLN0.BR.BRep01", self._reports, entry_id=self._chance.choice((None, bytes(8)))
        )

    def _pull(self, client: Client) -> None:
        """As the collector does it."""
        for record in understand([FolderListing("EVENTS", client.files("EVENTS"))]).records[:5]:
            if max(file.size for file in record.files) <= MAX_FILE_BYTES:
                with self._store.incoming() as incoming:
                    pull(client, record, incoming, max_file_bytes=MAX_FILE_BYTES, on_bytes=lambda _: None)
                    incoming.keep()


def main(port: int, seed: str, directory: Path) -> None:
    visitor = Visitor(port, seed, directory)
    campaign = os.getppid()
    while os.getppid() == campaign:  # however that ends
        try:
            visitor.visit()
        except ConnectFailed:
            continue
        except MmsError:
            continue
        except Exception:  # noqa: BLE001 (that there is none is what is tested)
            print(repr(traceback.format_exc()), flush=True)  # noqa: T201 (the campaign reads it)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2], Path(sys.argv[3]))
