"""`mcc serve`, `mcc collect` and `mcc work`: the service, gateways or workers alone, in the foreground."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError

from service.application.serve import ServeError, collect, serve
from service.application.work import work
from service.cli.output import failing_clearly
from service.configuration.environment import BUCKET, OURS, withhold
from service.configuration.settings import Settings, SettingsError
from service.plant import PlantError
from service.process.logs import configure_logging
from service.process.private_files import close_to_others, written_privately
from service.process.single_instance import AlreadyRunningError
from service.storage import StorageError

TROUBLES = (SettingsError, PlantError, StorageError, AlreadyRunningError, ServeError, OSError)


def run_service(config: Path | None) -> None:
    """Run until SIGTERM or Ctrl-C. Raises CommandError where the service cannot start."""
    with failing_clearly(*TROUBLES, SQLAlchemyError):
        settings = Settings.load(config)
        configure_logging("service", settings.log_format)
        with _guarded(settings):
            serve(settings, config)


def run_gateways(config: Path | None) -> None:
    """Run until SIGTERM or Ctrl-C. Raises CommandError where the gateways cannot start."""
    with failing_clearly(*TROUBLES, SQLAlchemyError):
        settings = Settings.load(config)
        configure_logging("gateways", settings.log_format)
        with _guarded(settings):
            collect(settings)


def run_workers(config: Path | None) -> None:
    """Run until SIGTERM or Ctrl-C. Raises CommandError where the workers cannot start or go on."""
    with failing_clearly(*TROUBLES, SQLAlchemyError):
        settings = Settings.load(config)
        configure_logging("workers", settings.log_format)
        with _guarded(settings):
            work(settings)


@contextmanager
def _guarded(settings: Settings) -> Iterator[None]:
    """Keep files from other users, and secrets from processes that do not need them."""
    withhold(OURS)
    if settings.recordings_url is None:
        withhold(BUCKET)
    with written_privately():
        close_to_others((settings.data_directory, settings.recordings_directory))
        yield
