"""The API as the service runs it, in a process of its own: python -m benchmarks.storage.server URL."""

import sys
import tempfile
from pathlib import Path

from fastapi import FastAPI

from service.api import ApiContext, create_app
from service.api.server import ApiServer, connection_limits
from service.application.serve import listening
from service.configuration.settings import Settings
from service.process.garbage_collection import spare_what_stays
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect


def api_on(repository: Repository, directory: Path) -> FastAPI:
    """Return the API on a filled database; its recording store is empty."""
    settings = Settings(data_directory=directory)
    return create_app(ApiContext(settings, repository, RecordingStore(directory / "recordings")))


def main() -> None:
    """Print the port, then answer until the process is ended."""
    with tempfile.TemporaryDirectory() as name:
        settings = Settings(data_directory=Path(name), port=0)
        app = api_on(Repository(connect(sys.argv[1])), settings.data_directory)
        spare_what_stays()
        with listening(settings) as listener:
            print(listener.getsockname()[1], flush=True)
            ApiServer(app, connection_limits(settings)).run(sockets=[listener])


if __name__ == "__main__":
    main()
