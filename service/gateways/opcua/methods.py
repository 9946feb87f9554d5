"""Methods of the server: have a motor recorded, and acknowledge an alarm. Each needs the right role."""

import time
from collections.abc import Callable
from functools import partial
from typing import Final

import structlog
from asyncua import Server, ua
from asyncua.common.utils import ServiceError
from sqlalchemy.exc import SQLAlchemyError

from service.access.permissions import Permission
from service.configuration.settings import Settings
from service.gateways.opcua.namespaces import OURS
from service.gateways.opcua.users import CALLER, PlantUser, actor_of, has_changed
from service.gateways.opcua.worker_threads import WorkerThreads
from service.storage import NotFoundError, Repository, StorageError
from service.storage.records import Actor
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

LONGEST: Final = 500
CALLS_AT_ONCE: Final = 2
"""Calls that are done at a time."""
TEXT: Final = ua.VariantType.String

Work = Callable[[Actor], list[ua.Variant]]


class PlantMethods:
    """The methods, on an object of their own."""

    def __init__(self, server: Server, repository: Repository, settings: Settings) -> None:
        self._server = server
        self._repository = repository
        self._settings = settings
        self._threads = WorkerThreads("method", CALLS_AT_ONCE)

    def close(self) -> None:
        """Do nothing more."""
        self._threads.close()

    async def begin(self) -> None:
        """Make the object with its methods."""
        index = await self._server.get_namespace_index(OURS)
        service = await self._server.nodes.objects.add_object(
            ua.NodeId("service", index), ua.QualifiedName("StatorWatch", index)
        )
        await service.add_method(
            ua.NodeId("service/TriggerRecording", index),
            ua.QualifiedName("TriggerRecording", index),
            self._trigger,
            [_argument("Motor", "Name of the motor")],
            [_argument("Request", "Id of the recording request")],
        )
        await service.add_method(
            ua.NodeId("service/Acknowledge", index),
            ua.QualifiedName("Acknowledge", index),
            self._acknowledge,
            [_argument("Alarm", "Id of the alarm"), _argument("Comment", "Why; may be empty")],
            [],
        )

    async def _trigger(self, _parent: ua.NodeId, motor: ua.Variant) -> object:
        def request(by: Actor) -> list[ua.Variant]:
            made = self._repository.request_recording(
                str(motor.Value)[:LONGEST],
                by=by,
                now_ns=time.time_ns(),
                most_open=self._settings.max_open_requests,
            )
            return [ua.Variant(made.id, TEXT)]

        return await self._allowed(Permission.TRIGGER, request)

    async def _acknowledge(self, _parent: ua.NodeId, alarm: ua.Variant, comment: ua.Variant) -> object:
        def acknowledge(by: Actor) -> list[ua.Variant]:
            words = str(comment.Value or "").strip()[:LONGEST].replace("\x00", "")
            self._repository.acknowledge_alarm(
                str(alarm.Value)[:LONGEST], by=by, now_ns=time.time_ns(), comment=words or None
            )
            return []

        return await self._allowed(Permission.ACKNOWLEDGE, acknowledge)

    async def _allowed(self, permission: Permission, work: Work) -> object:
        """Return what the work gives, or the status that tells the client why there is nothing."""
        caller = CALLER.get()
        try:
            return await self._threads.run(partial(self._done, caller, permission, work))
        except ServiceError as error:
            log.warning("a method is not waited for any longer", reason=ua.StatusCode(error.code).name)
            return ua.StatusCode(error.code)
        except NotFoundError as error:
            log.info("a method was refused", reason=str(error))
            return ua.StatusCode(ua.StatusCodes.BadNotFound)
        except StorageError as error:
            log.info("a method was refused", reason=str(error))
            return ua.StatusCode(ua.StatusCodes.BadInvalidState)
        except SQLAlchemyError as error:
            log.warning("a method failed", error=database_trouble(error))
            return ua.StatusCode(ua.StatusCodes.BadResourceUnavailable)

    def _done(self, caller: PlantUser | None, permission: Permission, work: Work) -> object:
        """Do the work for a caller whose account allows it now."""
        if caller is None or caller.account is None or not caller.may(permission):
            return ua.StatusCode(ua.StatusCodes.BadUserAccessDenied)
        if has_changed(self._repository, caller.account):
            return ua.StatusCode(ua.StatusCodes.BadUserAccessDenied)
        return work(actor_of(caller.account, caller.address))


def _argument(name: str, meaning: str) -> ua.Argument:
    return ua.Argument(
        Name=name,
        DataType=ua.NodeId(ua.ObjectIds.String),
        ValueRank=-1,
        ArrayDimensions=[],
        Description=ua.LocalizedText(meaning),
    )
