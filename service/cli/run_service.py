"""`mcc serve` and `mcc collect`: the service, or gateways alone, in the foreground."""

from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError

from service.cli.output import failing_clearly
from service.exclusive import AlreadyRunningError
from service.logs import configure_logging
from service.plant import PlantError
from service.serve import ServeError, collect, serve
from service.settings import Settings, SettingsError
from service.storage import StorageError

TROUBLES = (SettingsError, PlantError, StorageError, AlreadyRunningError, ServeError, OSError)


def run_service(config: Path | None) -> None:
    """Run until SIGTERM or Ctrl-C. Raises CommandError where the service cannot start."""
    configure_logging("service")
    with failing_clearly(*TROUBLES, SQLAlchemyError):
        serve(Settings.load(config))


def run_gateways(config: Path | None) -> None:
    """Run until SIGTERM or Ctrl-C. Raises CommandError where the gateways cannot start."""
    configure_logging("gateways")
    with failing_clearly(*TROUBLES, SQLAlchemyError):
        collect(Settings.load(config))
