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
from mms.references import FunctionalConstraint, object_reference

_REMOTE_CONTROL: Final = 3
_CONTROL_ROOM: Final = len("$CO$SBOw")
_LONGEST_ORIGINATOR: Final = 16  # a long orIdent has rebooted relays in the field
_LOOK_FOR_LOSS_S: Final = 0.1


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
    """Make the library's control object, which asks the relay for its description.

    The relay is asked again if its description came too late.
    """
    for _ in range(2):
        began_s = time.monotonic()
        control = connection.lib.ControlObjectClient_create(object_name, pointer)
        if control:
            return int(control)
        is_late = time.monotonic() - began_s >= connection.request_timeout_s
        why = _no_control(connection, operation, reference)
        if not is_late or not isinstance(why, errors.ProtocolError):
            raise why
    raise errors.Timeout(connection.host, operation, 0, "no answer in time")


def _no_control(connection: Connection, operation: str, reference: str) -> errors.MmsError:
    """Find out why the library made no control object: it does not pass on the error of what it asked for."""
    lib = connection.lib
    model = request_value(connection, operation, f"{reference}.ctlModel", FunctionalConstraint.CF)
    try:
        found = decode(lib, model)
    except ValueError as error:
        return errors.ProtocolError(connection.host, operation, 0, str(error))
    finally:
        lib.MmsValue_delete(model)
    if found == ControlModel.STATUS_ONLY:
        return _status_only(connection, operation)
    if isinstance(found, int):
        return errors.ProtocolError(connection.host, operation, 0, "the object has no Oper with ctlVal and T")
    return errors.NotFound(connection.host, operation, 0, "no such controllable object: it has no ctlModel")


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

    def execute(self, *, value: bool) -> None:
        number = int(self._lib.ControlObjectClient_getControlModel(self._control))
        if number not in set(ControlModel):
            raise errors.ProtocolError(
                self._connection.host, self._operation, 0, f"unknown ctlModel {number}"
            )
        model = ControlModel(number)
        if model is ControlModel.STATUS_ONLY:
            raise _status_only(self._connection, self._operation)
        enhanced = model in (ControlModel.DIRECT_ENHANCED, ControlModel.SBO_ENHANCED)
        handler = CommandTerminationHandler(guarded(self._on_termination, None))
        control_value = self._lib.MmsValue_newBoolean(value)
        try:
            if enhanced:
                self._lib.ControlObjectClient_setCommandTerminationHandler(self._control, handler, None)
            self._select(model, control_value)
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

    def _last_error(self) -> int:
        return int(self._lib.ControlObjectClient_getLastError(self._control))

    def _refusal(self, step: str) -> errors.MmsError:
        code = self._last_error()
        error = self._connection.resolve_timeout(
            errors.client_error(self._connection.host, self._operation, code)
        )
        if isinstance(error, errors.ConnectionLost | errors.Timeout):
            return error
        applied = self._lib.ControlObjectClient_getLastApplError(self._control)
        cause = words_of(applied.addCause)
        return errors.ControlRefused(
            self._connection.host, self._operation, code, f"the relay refused to {step}: {cause}", cause
        )
