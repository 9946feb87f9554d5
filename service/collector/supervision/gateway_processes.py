"""The gateway processes of this installation: as many as its relays need, each kept running."""

import time

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.collector.gateway.process import gateway_id
from service.collector.session.quarantine import QuarantinePolicy
from service.collector.session.visit_marks import VisitMarks
from service.collector.supervision.crash_blame import blame_after_end
from service.collector.supervision.gateway_supervisor import GatewaySupervisor
from service.configuration.settings import Settings
from service.plant import Plant
from service.storage import Repository, StorageError

log = structlog.get_logger(__name__)


class GatewayProcesses:
    """Started and stopped together; one that ends frees its relays and is started again.

    Raises OSError where the installation's name cannot be kept.
    """

    def __init__(self, settings: Settings, plant: Plant, repository: Repository) -> None:
        self._settings = settings
        self._repository = repository
        number = -(-len(plant.relays) // settings.relays_per_gateway)
        self._supervisors = [self._supervisor(of) for of in range(number)]

    def start(self) -> None:
        for supervisor in self._supervisors:
            supervisor.start()

    def stop(self) -> None:
        """Ask all to end, then wait for each."""
        for supervisor in self._supervisors:
            supervisor.ask_to_end()
        for supervisor in self._supervisors:
            supervisor.stop()

    def problem(self) -> str | None:
        """How many do not run at present; None while all do."""
        failing = [found for found in (each.problem() for each in self._supervisors) if found is not None]
        if not failing:
            return None
        return f"{len(failing)} of {len(self._supervisors)}: {failing[0]}"

    def _supervisor(self, number: int) -> GatewaySupervisor:
        gateway = gateway_id(self._settings, number)

        def ended(exit_code: int | None) -> None:
            """The process is dead for sure: nobody needs to wait for its leases to run out."""
            try:
                blame_after_end(
                    VisitMarks.of_gateway(self._settings.data_directory, number),
                    exit_code,
                    self._repository,
                    QuarantinePolicy(self._settings.quarantine_s),
                )
            except (SQLAlchemyError, StorageError, OSError) as error:
                log.warning("nobody is set aside for the gateway's end", error=str(error))
            try:
                self._repository.end_gateway(gateway, now_ns=time.time_ns())
            except SQLAlchemyError as error:
                log.warning("the leases run out by themselves", error=str(error))

        return GatewaySupervisor(self._settings, number=number, on_end=ended)
