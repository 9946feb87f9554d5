"""The service as a whole: gateways, diagnosis workers, REST API, on one data directory; or gateways alone."""

import os
import signal
import socket
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from ipaddress import IPv6Address
from pathlib import Path
from tempfile import TemporaryFile, gettempdir
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.access.refusals import Refusals
from service.api.access.certificate import CertificateError, ServerCertificate
from service.api.context import ApiContext, Problem
from service.api.server import ApiServer, connection_limits
from service.application.diagnosing import job_runner
from service.application.parts import Part, running
from service.audit.actions import AuditAction
from service.background.workers import background_workers
from service.collector.supervision.gateway_processes import GatewayProcesses
from service.condition.motor_data import document_of
from service.configuration.described import described
from service.configuration.problems import Problems
from service.configuration.relay_access import clear_passwords
from service.configuration.settings import Settings, SettingsError
from service.gateways.supervision import PlantGateways, missing_library
from service.jobs.runner import JobRunner
from service.notifications.checking import channel_problems, report_problems, route_problems, warnings
from service.notifications.work import NotificationWork
from service.plant import Plant, read_plant
from service.process.disk_space import disk_problem
from service.process.garbage_collection import spare_what_stays
from service.process.installation import installation_id
from service.process.sealing import Seal, SealError
from service.process.single_instance import exclusive
from service.process.termination import Termination
from service.recording_store.errors import StoreError
from service.recording_store.opening import open_store, store_warnings
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect, migrate
from service.storage.answering import answering
from service.storage.records import SERVICE
from service.storage.transaction_limits import limits_of
from service.supervision.supervised_process import RESTART_POLICY
from service.timing.database_silence import database_trouble, does_not_answer
from service.web.app import create_site, end_streams

log = structlog.get_logger(__name__)


class ServeError(RuntimeError):
    """The service cannot listen, or keep its data, where it should."""


def serve(settings: Settings, settings_file: Path | None = None) -> None:
    """Run until SIGTERM or SIGINT; every process of the service has ended afterwards.

    settings_file: where the settings are from; it goes into back-ups.
    Raises PlantError, SettingsError, StorageError, AlreadyRunningError, ServeError.
    """
    termination = Termination()
    with termination.heeded():
        _serve(settings, settings_file, termination)
    log.info("service ended")


def _serve(settings: Settings, settings_file: Path | None, termination: Termination) -> None:
    """Start step by step, and answer requests until a signal comes. Raises SystemExit during the start."""
    plant = checked_plant(settings)
    _require_sign_on(settings)
    if (missing := missing_library(settings)) is not None:
        raise ServeError(missing)
    certificate = _certificate(settings)
    require_writable(settings.data_directory)
    termination.step()
    with exclusive(settings.data_directory / "service.lock", wait=False), listening(settings) as listener:
        _require_seal(settings)
        repository = _prepared(settings, plant)
        termination.step()
        store = _opened_store(settings)
        store.discard_incoming()
        refusals = Refusals()
        jobs, parts = _parts(settings, settings_file, plant, repository, store, termination, refusals)
        integrations = PlantGateways(settings)
        room: dict[str, Problem] = {
            "disk": partial(disk_problem, _written(settings, store)),
            "recordings": store.problem,
        }
        readiness = room | {name: part.problem for name, part in parts.items()}
        context = ApiContext(
            settings,
            repository,
            store,
            readiness=readiness,
            on_new_job=jobs.wake,
            motors={motor.name: motor.motor for motor in plant.motors},
            time_zones=plant.time_zones(),
            compute=jobs.compute,
            integrations=integrations.status,
            refusals=refusals,
        )
        termination.step()
        # They come up last, and are no part of what makes the service ready: nothing here waits for them.
        with _noted(repository, settings, refusals), running([*parts.values(), integrations]):
            host, port = listener.getsockname()[:2]
            log.info("serving", host=host, port=port, tls=certificate is not None, motors=len(plant.motors))
            _answer(context, listener, termination, certificate)


@contextmanager
def _noted(repository: Repository, settings: Settings, refusals: Refusals) -> Iterator[None]:
    """Have the audit trail tell of the settings, of the start, and at the end of what was refused last."""
    installation = installation_id(settings.data_directory)
    repository.note_settings(described(settings), installation, now_ns=time.time_ns())
    this = {"version": version("statorwatch"), "host": socket.gethostname(), "process": os.getpid()}
    subject = ("service", installation)
    repository.note_by(SERVICE, AuditAction.SERVICE_STARTED, subject, now_ns=time.time_ns(), after=this)
    try:
        yield
    finally:
        try:
            refusals.settle(repository, ending=True)
            repository.note_by(SERVICE, AuditAction.SERVICE_ENDED, subject, now_ns=time.time_ns(), after=this)
        except SQLAlchemyError as error:
            if not does_not_answer(error):
                raise
            log.warning("the audit trail does not tell of the end", error=database_trouble(error))


def _require_sign_on(settings: Settings) -> None:
    """Raise ServeError where a provider is named and the library that speaks with it is not installed."""
    if settings.access.oidc is not None and find_spec("authlib") is None:
        raise ServeError(
            'access.oidc: expected the library authlib, found none: pip install "statorwatch[oidc]"'
        )


def _require_seal(settings: Settings) -> None:
    """Make the key of sealed secrets at the first start. Raises ServeError where it cannot be used."""
    try:
        Seal(settings.secrets_key_file)
    except SealError as error:
        raise ServeError(str(error)) from error


def _certificate(settings: Settings) -> ServerCertificate | None:
    """Read the API's certificate, or warn where passwords would go over a network. Raises ServeError."""
    if settings.tls_certificate is not None and settings.tls_key is not None:
        try:
            return ServerCertificate(settings.tls_certificate, settings.tls_key)
        except CertificateError as error:
            raise ServeError(str(error)) from error
    if not settings.bind_address.is_loopback and settings.access.proxy is None:
        log.warning(
            "passwords and tokens go over the network in clear: set tls_certificate and tls_key, or name the "
            "proxy that ends TLS (access.proxy)",
            bind_address=str(settings.bind_address),
        )
    return None


def _prepared(settings: Settings, plant: Plant) -> Repository:
    """Open the database and bring it up to date. Raises StorageError."""
    with answering(settings.database_url):
        migrate(settings.database_url)
        repository = Repository(connect(settings.database_url, limits=limits_of(settings)))
        repository.sync_plant(plant, noted_ns=time.time_ns())
        documents = {motor.name: document_of(motor.motor) for motor in plant.motors}
        repository.note_motors(documents, now_ns=time.time_ns())
        repository.settle_alarms(now_ns=time.time_ns(), rules=settings.alarms.condition_rules)
        repository.settle_start_alarms(now_ns=time.time_ns())
        repository.reset_links(now_ns=time.time_ns())
    return repository


def collect(settings: Settings) -> None:
    """Run gateways alone, which share the relays of a service elsewhere, until SIGTERM or SIGINT.

    Raises PlantError, SettingsError, StorageError (also where that service's database does not answer),
    AlreadyRunningError, ServeError.
    """
    end = Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: end.set())
    plant = checked_plant(settings)
    require_writable(settings.data_directory)
    with exclusive(settings.data_directory / "service.lock", wait=False):
        repository = Repository(connect(settings.database_url, limits=limits_of(settings)))
        with answering(settings.database_url):
            repository.check()
        with running([GatewayProcesses(settings, plant, repository)]):
            log.info("collecting for a service elsewhere", relays=len(plant.relays))
            end.wait()
    log.info("collecting ended")


def checked_plant(settings: Settings) -> Plant:
    """Read the plant. Raises PlantError, SettingsError."""
    problems = Problems()
    plant = read_plant(settings, problems)
    for warning in problems.warnings:
        log.warning("the plant's files", warning=warning)
    sites = [site.name for site in plant.sites]
    motors = [motor.name for motor in plant.motors]
    wrong = route_problems(settings.notifications, sites, "settings")
    wrong += report_problems(settings.reports, sites, motors, "settings")
    if wrong:
        raise SettingsError(wrong)
    for problem in channel_problems(settings.notifications, "settings"):
        log.error("a channel cannot be used; its messages wait", problem=str(problem))
    for warning in warnings(settings.notifications, sites):
        log.warning("notifications", warning=warning)
    for warning in store_warnings(settings):
        log.warning("the store of the recordings", warning=warning)
    for relay in clear_passwords(settings.relays, [relay.name for relay in plant.relays]):
        log.warning("the relay's password goes over the network in clear: configure TLS for it", relay=relay)
    return plant


def _answer(
    context: ApiContext,
    listener: socket.socket,
    termination: Termination,
    certificate: ServerCertificate | None,
) -> None:
    """Answer requests until a signal comes. Raises SystemExit where one came before the first request."""
    termination.step()
    settings = context.settings
    site = create_site(context)
    server = ApiServer(
        site, connection_limits(settings), termination, certificate, on_shutdown=partial(end_streams, site)
    )
    spare_what_stays()
    termination.step()
    server.run(sockets=[listener])


def _parts(
    settings: Settings,
    settings_file: Path | None,
    plant: Plant,
    repository: Repository,
    store: RecordingStore,
    termination: Termination,
    refusals: Refusals,
) -> tuple[JobRunner, Mapping[str, Part]]:
    """The job runner, and all parts of the service by the names that GET /readyz lists."""
    gateways = GatewayProcesses(settings, plant, repository)
    jobs = job_runner(settings, plant, repository, store, is_ending=lambda: termination.is_asked)
    workers = background_workers(
        settings,
        plant,
        repository,
        store,
        gateway_problem=gateways.not_running,
        restart_delay_s=RESTART_POLICY.backoff.longest_s,
        compute=jobs.compute,
        refusals=refusals,
        settings_file=settings_file,
        directories=_written(settings, store),
    )
    notifications = NotificationWork(
        settings, repository, installation=installation_id(settings.data_directory)
    )
    return jobs, {"collector": gateways, "jobs": jobs, **workers, "notifications": notifications}


def _opened_store(settings: Settings) -> RecordingStore:
    """Open the store of the recordings as this service. Raises ServeError, OSError."""
    try:
        return open_store(settings, installation_id(settings.data_directory))
    except StoreError as error:
        raise ServeError(str(error)) from error


def _written(settings: Settings, store: RecordingStore) -> list[Path]:
    """The directories that the service writes to; uploads and downloads pass through the last one."""
    return list(dict.fromkeys((settings.data_directory, *store.written, Path(gettempdir()))))


def require_writable(directory: Path) -> None:
    """Raise ServeError where no file can be written."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=directory):
            pass
    except OSError as error:
        raise ServeError(
            f"{directory}: expected a directory that user {os.getuid()} may write to "
            f"(setting data_directory), found: {error.strerror}"
        ) from error


@contextmanager
def listening(settings: Settings) -> Iterator[socket.socket]:
    """Open the API's socket, before anything is started: a busy port would end it all again.

    Raises ServeError.
    """
    address = settings.bind_address
    family = socket.AF_INET6 if isinstance(address, IPv6Address) else socket.AF_INET
    try:
        listener = socket.create_server((str(address), settings.port), family=family)
    except OSError as error:
        raise ServeError(
            f"{address}:{settings.port}: expected a free port on an address of this machine "
            f"(settings bind_address, port), found: {error.strerror}"
        ) from error
    with listener:
        # The connections inherit it. The body of an answer would else wait for the client's acknowledgement
        # of the header, 40 ms: asyncio sets it for sockets only that were made with the protocol's number.
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        yield listener
