"""What uploads of a record that is known leave in the recording store.

    python -m benchmarks.storage.known_uploads

A record of 10 MB is uploaded, and then nineteen times more, each time with another header. Printed are the
folders and the size of the store after the first upload and after the last. The exit code is 1 where they
differ.
"""

import os
import sys
import tempfile
from pathlib import Path

from fastapi.testclient import TestClient

from service.api import ApiContext, create_app
from service.client.credentials import bearer
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from testing.service.accounts import token_of
from testing.service.database import make_database
from testing.service.plants import two_motor_plant

REPEATS = 19
RECORD = {"E.CFG": b"config", "E.DAT": os.urandom(10_000_000)}


def main() -> int:
    """Upload, look at the store, and return 1 where a folder is left that nothing needs."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-uploads-") as name:
        directory = Path(name)
        settings = Settings(data_directory=directory)
        repository = Repository(connect(make_database(directory)))
        repository.sync_plant(two_motor_plant())
        store = FolderStore(settings.recordings_directory)
        with TestClient(
            create_app(ApiContext(settings, repository, store)),
            base_url="http://localhost",
            headers=bearer(token_of(repository)),
        ) as client:
            _upload(client, b"the first")
            first = _show("after the first upload", store)
            for number in range(REPEATS):
                _upload(client, b"header %d" % number)
            return 0 if _show(f"after {REPEATS} more with other headers", store) == first else 1


def _upload(client: TestClient, header: bytes) -> None:
    files = [("files", (name, content)) for name, content in {**RECORD, "E.HDR": header}.items()]
    answer = client.post("/api/v1/recordings", data={"motor": "PUMP-A1"}, files=files)
    answer.raise_for_status()


def _show(when: str, store: FolderStore) -> tuple[int, int]:
    folders = list(store.root.glob("??/*"))
    size_bytes = sum(path.stat().st_size for path in store.root.rglob("*") if path.is_file())
    print(f"{when}: {len(folders)} folders, {size_bytes / 1e6:.1f} MB")
    return len(folders), size_bytes


if __name__ == "__main__":
    sys.exit(main())
