"""A host of workers as a process of its own, which a test can freeze: python -m tests.service.jobs.host.

Its arguments: the database's URL, the folder of the recordings, the installation and the lease [s]. It
ends when its standard input does.
"""

import sys
from dataclasses import replace
from pathlib import Path

from service.process.logs import configure_logging
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.transaction_limits import TransactionLimits
from tests.service.jobs.running import LIMITS, running


def main(url: str, recordings: str, installation: str, lease_s: str) -> None:
    configure_logging("host", "json")
    limits = replace(LIMITS, workers=1, lease_s=float(lease_s))
    store = FolderStore(Path(recordings), installation)
    engine = connect(url, limits=replace(TransactionLimits.of_lease(limits.lease_s), lock_wait_s=60.0))
    with running(Repository(engine), store, limits, installation=installation):
        sys.stdin.read()


if __name__ == "__main__":
    main(*sys.argv[1:])
