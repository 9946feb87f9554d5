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
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from testing.service.accounts import auditor_token


def api_on(repository: Repository, directory: Path) -> FastAPI:
    """Return the API on a filled database, with a token for what is asked of it; its store is empty."""
    settings = Settings(data_directory=directory)
    app = create_app(ApiContext(settings, repository, FolderStore(directory / "recordings")))
    app.state.token = auditor_token(repository)
    return app


def main() -> None:
    """Print the port and a token, then answer until the process is ended."""
    with tempfile.TemporaryDirectory() as name:
        settings = Settings(data_directory=Path(name), port=0)
        app = api_on(Repository(connect(sys.argv[1])), settings.data_directory)
        spare_what_stays()
        with listening(settings) as listener:
            print(listener.getsockname()[1], app.state.token, flush=True)
            ApiServer(app, connection_limits(settings)).run(sockets=[listener])


if __name__ == "__main__":
    main()
