"""The site as the service runs it, in a process of its own: python -m benchmarks.web.server DATA [URL]."""

import sys
from functools import partial
from pathlib import Path

from service.api import ApiContext
from service.api.server import ApiServer, connection_limits
from service.application.serve import listening
from service.configuration.settings import Settings, sqlite_url
from service.process.garbage_collection import spare_what_stays
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.web.app import create_site, end_streams
from testing.web.site import log_in


def main() -> None:
    """Print the port and a session of who may do most, then answer until the process is ended."""
    data = Path(sys.argv[1])
    settings = Settings(data_directory=data, port=0)
    repository = Repository(connect(sys.argv[2] if len(sys.argv) > 2 else sqlite_url(data)))
    app = create_site(ApiContext(settings, repository, FolderStore(data / "recordings")))
    session = log_in(repository)
    spare_what_stays()
    with listening(settings) as listener:
        print(listener.getsockname()[1], session, flush=True)
        limits, end = connection_limits(settings), partial(end_streams, app)
        ApiServer(app, limits, on_shutdown=end).run(sockets=[listener])


if __name__ == "__main__":
    main()
