"""Controls of a server: a client's Operate is handed to a handler, which accepts or refuses it.

The control model decides when the handler is asked. With normal security it is asked before the response, so
that a refusal is a negative response. With enhanced security it is asked after the response, so that a
refusal is a negative CommandTermination.
"""

import ctypes
from collections.abc import Callable
from dataclasses import dataclass

from mms.binding.callbacks import guarded
from mms.binding.prototypes import ControlHandler, WaitForExecutionHandler
from mms.binding.value_conversion import decode
from mms.control_model import AddCause
from mms.values import Value

_FAILED, _OK = 0, 1  # ControlHandlerResult


@dataclass(frozen=True, slots=True)
class ControlAction:
    """A client's Operate (IEC 61850-7-2 clause 20).

    Parameters
    ----------
    reference : str
        Reference of the controllable object.
    value : Value
        The value to bring the object to.
    test : bool
        Whether the client only tests the control.
    originator : str
        Identification of the originator.
    originator_category : int
        Category of the originator, orCat.
    control_number : int
        Number of the control, ctlNum.
    """

    reference: str
    value: Value
    test: bool
    originator: str
    originator_category: int
    control_number: int


OperateHandler = Callable[[ControlAction], "bool | AddCause"]


def install_operate_handler(
    lib: ctypes.CDLL, server: int, node: int, reference: str, handler: OperateHandler, *, enhanced: bool
) -> object:
    """Let a handler decide about each Operate of a controllable object.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    server : int
        Pointer to the IedServer.
    node : int
        Pointer to the data object.
    reference : str
        Reference of the data object, "LD/LN.DO".
    handler : callable
        Called with a ControlAction. It returns True to accept, False or an AddCause to refuse.
    enhanced : bool
        Whether the control model of the object has enhanced security.

    Returns
    -------
    object
        The ctypes callback, to be held for as long as the server lives.
    """

    def operated(action: int, _parameter: int | None, value: int, test: bool) -> int:
        return _decide(lib, reference, handler, action, value, test=test)

    def checked_dynamically(
        action: int, parameter: int | None, value: int, test: bool, _synchro_check: bool
    ) -> int:
        return operated(action, parameter, value, test)

    if enhanced:
        execute = ControlHandler(guarded(operated, _FAILED))
        lib.IedServer_setControlHandler(server, node, execute, None)
        return execute
    check = WaitForExecutionHandler(guarded(checked_dynamically, _FAILED))
    lib.IedServer_setWaitForExecutionHandler(server, node, check, None)
    return check


def _decide(
    lib: ctypes.CDLL, reference: str, handler: OperateHandler, action: int, value: int, *, test: bool
) -> int:
    """Ask the handler and return a ControlHandlerResult."""
    lib.ControlAction_setAddCause(action, int(AddCause.BLOCKED_BY_PROCESS))
    size = ctypes.c_int(0)
    identity = lib.ControlAction_getOrIdent(action, ctypes.byref(size))
    originator = (
        ctypes.string_at(identity, size.value).decode("latin-1") if identity and size.value > 0 else ""
    )
    verdict = handler(
        ControlAction(
            reference,
            decode(lib, value),
            test,
            originator,
            int(lib.ControlAction_getOrCat(action)),
            int(lib.ControlAction_getCtlNum(action)),
        )
    )
    if verdict is True:
        return _OK
    if isinstance(verdict, AddCause):
        lib.ControlAction_setAddCause(action, int(verdict))
    return _FAILED
