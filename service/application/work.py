"""Workers alone: they diagnose for a service elsewhere, whose database and recordings they share."""

import signal
from collections.abc import Mapping
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from core.machines.parameters import Motor
from service.application.diagnosing import job_runner
from service.application.parts import running
from service.application.serve import ServeError, checked_plant, require_writable
from service.condition.motor_data import document_of
from service.configuration.settings import Settings
from service.process.installation import installation_id
from service.process.single_instance import exclusive
from service.recording_store.errors import RecordingStoreError, StoreError
from service.recording_store.opening import SHARE_THEM, open_shared_store
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.answering import answering
from service.storage.database_url import parsed_url
from service.storage.migrations import require_current_tables
from service.storage.transaction_limits import limits_of
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

LOOK_S = 5.0
"""How often workers look whether the service still has the motors that they have."""

LATEST = 20
"""One of so many recordings, the latest ones, must be here if any is stored."""


def work(settings: Settings) -> None:
    """Take jobs of a service elsewhere until SIGTERM or SIGINT; what is under way then goes back.

    Raises PlantError, SettingsError, StorageError (also where the database does not answer),
    AlreadyRunningError, ServeError (also where the service gets other motors meanwhile).
    """
    end = Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: end.set())
    if parsed_url(settings.database_url).get_backend_name() == "sqlite":
        raise ServeError(
            "database_url: expected a PostgreSQL database, found an SQLite file, which hosts cannot share: "
            "set `workers` of the service itself higher, or have both use PostgreSQL"
        )
    plant = checked_plant(settings)
    motors = {motor.name: motor.motor for motor in plant.motors}
    with answering(settings.database_url):
        require_current_tables(settings.database_url)
    require_writable(settings.data_directory)
    with exclusive(settings.data_directory / "service.lock", wait=False):
        repository = Repository(connect(settings.database_url, limits=limits_of(settings)))
        require_same_motors(repository, motors)
        store = _shared_store(settings, repository)
        jobs = job_runner(settings, plant, repository, store, is_ending=end.is_set)
        with running([jobs]):
            log.info("working for a service elsewhere", workers=settings.workers, motors=len(motors))
            while not end.wait(LOOK_S):
                try:
                    require_same_motors(repository, motors)
                except SQLAlchemyError as error:
                    log.warning("motors not compared with the service's", reason=database_trouble(error))
    log.info("working ended")


def require_same_motors(repository: Repository, motors: Mapping[str, Motor]) -> None:
    """Raise ServeError unless the service has the same motors with the same data, SQLAlchemyError."""
    served = set(repository.schedules())
    different = sorted(served.symmetric_difference(motors)) or [
        name
        for name, motor in sorted(motors.items())
        if [version.document for version in repository.motor_versions(name)][-1:] != [document_of(motor)]
    ]
    if different:
        raise ServeError(
            f"motors: expected the motors that the service has, found others (such as {different[0]}): "
            "give the workers the service's own scd and motors files"
        )


def _shared_store(settings: Settings, repository: Repository) -> RecordingStore:
    """Open the service's recordings. Raises ServeError where they cannot be read here."""
    try:
        store = open_shared_store(settings, installation_id(settings.data_directory))
    except StoreError as error:
        raise ServeError(str(error)) from error
    digests = [one.digest for one in repository.recordings(limit=LATEST).items if one.digest is not None]
    if digests:
        _require_one_of(store, digests)
    return store


def _require_one_of(store: RecordingStore, digests: list[str]) -> None:
    """Raise ServeError where none of these recordings can be read; some may have been deleted meanwhile."""
    for digest in digests:
        try:
            with store.opened(digest) as entry, entry.open("rb") as file:
                file.read(1)
        except (RecordingStoreError, OSError) as error:
            problem = error
        else:
            return
    raise ServeError(f"{store.place}: expected the recordings of the service, found: {problem}; {SHARE_THEM}")
