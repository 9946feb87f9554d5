"""Run the gateway processes of this installation, as many as its relays need."""

import sys
import time
from functools import partial

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.collector.gateway.process import gateway_id
from service.collector.session.quarantine import QuarantinePolicy
from service.collector.session.visit_marks import VisitMarks
from service.collector.supervision.crash_blame import blame_after_end
from service.configuration.environment import BUCKET
from service.configuration.relay_access import PASSWORD_VARIABLE
from service.configuration.settings import Settings
from service.plant import Plant
from service.plant.handover import plant_to_bytes
from service.storage import Repository, StorageError
from service.supervision.supervised_process import SupervisedProcess
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

COLLECTOR = "the collector process"
COMMAND = (sys.executable, "-m", "service.collector")
"""With the gateway's number behind it."""


class GatewayProcesses:
    """Start and stop all gateways together. One that ends frees its relays and is started again.

    Raises OSError where the installation's name cannot be kept.
    """

    def __init__(self, settings: Settings, plant: Plant, repository: Repository) -> None:
        self._settings = settings
        self._repository = repository
        handed = plant_to_bytes(plant)
        secrets = (PASSWORD_VARIABLE,) if settings.recordings_url is None else (PASSWORD_VARIABLE, BUCKET)
        gateways = -(-len(plant.relays) // settings.relays_per_gateway)
        self._ids = [gateway_id(settings, number) for number in range(gateways)]
        self._supervisors = [
            SupervisedProcess(
                COLLECTOR,
                (*COMMAND, str(number)),
                settings,
                handed=handed,
                secrets=secrets,
                on_exit=partial(self._handle_exit, number, name),
            )
            for number, name in enumerate(self._ids)
        ]

    def start(self) -> None:
        """Start all gateways, and the threads that keep them running."""
        for supervisor in self._supervisors:
            supervisor.start()

    def stop(self) -> None:
        """Ask all gateways to end, then wait for each."""
        for supervisor in self._supervisors:
            supervisor.ask_to_end()
        for supervisor in self._supervisors:
            supervisor.stop()

    def problem(self) -> str | None:
        """Return which gateways do not run, or what does not work in one; None while all is well."""
        return self.not_running() or self._reported_problem()

    def not_running(self) -> str | None:
        """Return how many gateways do not run at present; None while all do."""
        failing = [found for found in (each.problem() for each in self._supervisors) if found is not None]
        if not failing:
            return None
        return f"{len(failing)} of {len(self._supervisors)}: {failing[0]}"

    def _reported_problem(self) -> str | None:
        """Return what the gateways wrote down with their latest heartbeats; None while all is well."""
        try:
            gateways = self._repository.gateways()
        except SQLAlchemyError as error:
            return f"what the gateways report is not known: {database_trouble(error)}"
        reported = [
            f"{each.id}: {each.problem}" for each in gateways if each.id in self._ids and each.problem
        ]
        return "; ".join(reported) or None

    def _handle_exit(self, number: int, gateway: str, exit_code: int | None) -> None:
        """Find the relay that brought the process down, if one did, and free the process's relays.

        The process is dead for sure, so nobody needs to wait until its leases expire.
        """
        try:
            blame_after_end(
                VisitMarks.of_gateway(self._settings.data_directory, number),
                exit_code,
                self._repository,
                QuarantinePolicy.starting_with(self._settings.quarantine_s),
            )
        except (SQLAlchemyError, StorageError, OSError) as error:
            log.warning("no relay is set aside for the gateway's end", error=str(error))
        try:
            self._repository.end_gateway(gateway, now_ns=time.time_ns())
        except SQLAlchemyError as error:
            log.warning("the leases expire by themselves", error=str(error))
