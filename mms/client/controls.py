"""Operation of a controllable object by the control model it declares (clause 20 of IEC 61850-7-2 and -8-1).

direct-with-normal-security      Operate
sbo-with-normal-security         Select, Operate
direct-with-enhanced-security    Operate, then CommandTermination
sbo-with-enhanced-security       SelectWithValue, Operate, then CommandTermination
"""

import threading
import time
from typing import Final

from mms import errors
from mms.binding.callbacks import guarded
from mms.binding.prototypes import CommandTerminationHandler
from mms.binding.value_conversion import decode
from mms.client.connection import Connection
from mms.client.data_values import request_value
from mms.control_model import AddCause, ControlModel, words_of
from mms.references import FunctionalConstraint, object_reference, variable_name
from mms.values import DataAccessError

_REMOTE_CONTROL: Final = 3
_CONTROL_ROOM: Final = len("$CO$SBOw")
_LONGEST_ORIGINATOR: Final = 16  # a long orIdent has rebooted relays in the field
_LOOK_FOR_LOSS_S: Final = 0.1
_PATIENCE_S: Final = (0.2, 0.5, 1.0)


def operate(connection: Connection, reference: str, *, value: bool, originator: str) -> None:
    """Bring a controllable object to a value by its control model.

    It returns when the relay has accepted the command or, with enhanced security, completed it.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    reference : str
        Reference "LD/LN.DO".
    value : bool
        The value to bring the object to.
    originator : str
        Identification of the originator, at most 16 ASCII characters.

    Raises
    ------
    ControlRefused
        The relay refuses; the error carries its add cause.
    Timeout
        The command termination does not come.
    ValueError
        The originator is too long.

    References
    ----------
    IEC 61850-7-2 clause 20; IEC 61850-8-1 clause 20.
    """
    operation = f"operate {reference}"
    object_name = object_reference(reference, names=2, room=_CONTROL_ROOM)
    origin = originator.encode("ascii")
    if len(origin) > _LONGEST_ORIGINATOR:
        raise ValueError(f"originator {originator!r} is longer than {_LONGEST_ORIGINATOR} characters")
    lib = connection.lib
    with connection.exclusive(operation) as pointer:
        control = _create(connection, operation, reference, object_name, pointer)
        try:
            lib.ControlObjectClient_setOrigin(control, origin, _REMOTE_CONTROL)
            lib.ControlObjectClient_setCtlNum(control, connection.count_command(reference))
            _Command(connection, operation, control).execute(value=value)
        finally:
            lib.ControlObjectClient_destroy(control)


def _create(connection: Connection, operation: str, reference: str, object_name: bytes, pointer: int) -> int:
    """Make the library's control object from the relay's description of it.

    A relay that is busy is asked again, one that answers too late once more.
    """
    lib = connection.lib
    domain, item = variable_name(reference, FunctionalConstraint.CO)
    pauses_s, was_late = iter(_PATIENCE_S), False
    while True:
        try:
            model = _control_model(connection, operation, reference)
            description = connection.request(
                operation, lib.MmsConnection_getVariableAccessAttributes, domain, item
            )
            break
        except errors.TemporarilyUnavailable:
            pause_s = next(pauses_s, None)
            if pause_s is None:
                raise
            time.sleep(pause_s)
        except errors.Timeout:
            if was_late:
                raise
            was_late = True
    if description is None:
        raise errors.ProtocolError(connection.host, operation, 0, "no description of the object came")
    try:
        control = lib.ControlObjectClient_createEx(object_name, pointer, model, description)
    finally:
        lib.MmsVariableSpecification_destroy(description)
    if not control:
        raise errors.ProtocolError(connection.host, operation, 0, "the object has no Oper with ctlVal and T")
    return int(control)


def _control_model(connection: Connection, operation: str, reference: str) -> ControlModel:
    model = request_value(connection, operation, f"{reference}.ctlModel", FunctionalConstraint.CF)
    try:
        found = decode(connection.lib, model)
    except ValueError as error:
        raise errors.ProtocolError(connection.host, operation, 0, str(error)) from error
    finally:
        connection.lib.MmsValue_delete(model)
    if found == DataAccessError.TEMPORARILY_UNAVAILABLE:
        raise errors.TemporarilyUnavailable(
            connection.host, operation, 0, "the relay gives no ctlModel for now"
        )
    if isinstance(found, bool | DataAccessError) or not isinstance(found, int):
        reason = "no such controllable object: it has no ctlModel"
        raise errors.NotFound(connection.host, operation, 0, reason)
    if found == ControlModel.STATUS_ONLY:
        raise _status_only(connection, operation)
    if found not in set(ControlModel):
        raise errors.ProtocolError(connection.host, operation, 0, f"unknown ctlModel {found}")
    return ControlModel(found)


def _status_only(connection: Connection, operation: str) -> errors.ControlRefused:
    cause = AddCause.NOT_SUPPORTED.words
    return errors.ControlRefused(connection.host, operation, 0, "the object is status-only", cause)


class _Command:
    """One command on one control object of the library."""

    def __init__(self, connection: Connection, operation: str, control: int) -> None:
        self._connection = connection
        self._lib = connection.lib
        self._operation = operation
        self._control = control
        self._terminated = threading.Event()
        self._asked_s = 0.0

    def execute(self, *, value: bool) -> None:
        model = ControlModel(int(self._lib.ControlObjectClient_getControlModel(self._control)))
        enhanced = model in (ControlModel.DIRECT_ENHANCED, ControlModel.SBO_ENHANCED)
        handler = CommandTerminationHandler(guarded(self._on_termination, None))
        control_value = self._lib.MmsValue_newBoolean(value)
        try:
            if enhanced:
                self._lib.ControlObjectClient_setCommandTerminationHandler(self._control, handler, None)
            self._select(model, control_value)
            self._asked_s = time.monotonic()
            if (
                not self._lib.ControlObjectClient_operate(self._control, control_value, 0)
                or self._last_error()
            ):
                raise self._refusal("operate")
            if enhanced:
                self._wait_for_termination()
        finally:
            self._lib.MmsValue_delete(control_value)

    def _select(self, model: ControlModel, control_value: int) -> None:
        self._asked_s = time.monotonic()
        if model is ControlModel.SBO_NORMAL and not self._lib.ControlObjectClient_select(self._control):
            raise self._refusal("select")
        if model is ControlModel.SBO_ENHANCED and not self._lib.ControlObjectClient_selectWithValue(
            self._control, control_value
        ):
            raise self._refusal("select")

    def _wait_for_termination(self) -> None:
        longest_s = self._connection.limits.command_termination_s
        deadline_s = time.monotonic() + longest_s
        while not self._terminated.wait(_LOOK_FOR_LOSS_S):
            host = self._connection.host
            if not self._connection.is_open:
                raise errors.ConnectionLost(host, self._operation, 0, "lost before the command termination")
            if time.monotonic() > deadline_s:
                reason = f"no command termination in {longest_s:g} s"
                raise errors.Timeout(host, self._operation, 0, reason)
        applied = self._lib.ControlObjectClient_getLastApplError(self._control)
        if applied.error or applied.addCause:
            raise self._refusal("complete")

    def _on_termination(self, _parameter: int | None, _control: int | None) -> None:
        self._terminated.set()

    def _is_late(self) -> bool:
        """Return whether the latest request took as long as an answer is waited for."""
        return time.monotonic() - self._asked_s >= self._connection.request_timeout_s

    def _last_error(self) -> int:
        return int(self._lib.ControlObjectClient_getLastError(self._control))

    def _refusal(self, step: str) -> errors.MmsError:
        code = self._last_error()
        error = self._connection.resolve_timeout(
            errors.client_error(self._connection.host, self._operation, code)
        )
        if isinstance(error, errors.Timeout) and not self._is_late():
            # The library says so, too, of a ServiceError in answer to the write.
            reason = f"the relay answered with a service error to {step}: it may be busy"
            return errors.ServiceFailed(self._connection.host, self._operation, code, reason)
        if isinstance(error, errors.ConnectionLost | errors.Timeout):
            return error
        applied = self._lib.ControlObjectClient_getLastApplError(self._control)
        cause = words_of(applied.addCause)
        return errors.ControlRefused(
            self._connection.host, self._operation, code, f"the relay refused to {step}: {cause}", cause
        )
