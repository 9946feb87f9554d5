"""The API as the service runs it, in a process of its own: python -m benchmarks.storage.server URL."""

import socket
import sys
import tempfile
from pathlib import Path

import uvicorn
from fastapi import FastAPI

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect


def api_on(repository: Repository, directory: Path) -> FastAPI:
    """Return the API on a filled database; its recording store is empty."""
    settings = Settings(data_directory=directory)
    return create_app(ApiContext(settings, repository, RecordingStore(directory / "recordings")))


def main() -> None:
    """Print the port, then answer until the process is ended."""
    with tempfile.TemporaryDirectory() as directory, socket.create_server(("127.0.0.1", 0)) as listener:
        app = api_on(Repository(connect(sys.argv[1])), Path(directory))
        print(listener.getsockname()[1], flush=True)
        configuration = uvicorn.Config(app, log_config=None, access_log=False, server_header=False)
        uvicorn.Server(configuration).run(sockets=[listener])


if __name__ == "__main__":
    main()
