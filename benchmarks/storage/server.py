"""The API as the service runs it, in a process of its own: python -m benchmarks.storage.server URL."""

import sys
import tempfile
from pathlib import Path

import uvicorn
from fastapi import FastAPI

from service.api import ApiContext, create_app
from service.application.serve import listening
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect


def api_on(repository: Repository, directory: Path) -> FastAPI:
    """Return the API on a filled database; its recording store is empty."""
    settings = Settings(data_directory=directory)
    return create_app(ApiContext(settings, repository, RecordingStore(directory / "recordings")))


def main() -> None:
    """Print the port, then answer until the process is ended."""
    with tempfile.TemporaryDirectory() as name:
        directory = Path(name)
        app = api_on(Repository(connect(sys.argv[1])), directory)
        configuration = uvicorn.Config(app, log_config=None, access_log=False, server_header=False)
        with listening(Settings(data_directory=directory, port=0)) as listener:
            print(listener.getsockname()[1], flush=True)
            uvicorn.Server(configuration).run(sockets=[listener])


if __name__ == "__main__":
    main()
