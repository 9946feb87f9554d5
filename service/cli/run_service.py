"""`mcc serve`: the service in the foreground."""

from pathlib import Path

from service.cli.output import failing_clearly
from service.exclusive import AlreadyRunningError
from service.logs import configure_logging
from service.plant import PlantError
from service.serve import ServeError, serve
from service.settings import Settings, SettingsError
from service.storage import StorageError


def run_service(config: Path | None) -> None:
    """Run until SIGTERM or Ctrl-C. Raises CommandError where the service cannot start."""
    configure_logging("service")
    with failing_clearly(SettingsError, PlantError, StorageError, AlreadyRunningError, ServeError, OSError):
        serve(Settings.load(config))
