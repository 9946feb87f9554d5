"""Handlers of one server: functions that the library calls for its clients' requests."""

import ctypes
from typing import Final

from mms.control_model import AddCause, ControlModel
from mms.server.attributes import Attributes
from mms.server.controls import ControlAction, OperateHandler, install_operate_handler
from mms.server.file_access import FileGuard, install_file_guard
from mms.server.model import Model, Node
from mms.server.read_access import ReadHandler, install_read_handlers


class Handlers:
    """Handlers of one server, with the ctypes callbacks that live as long as it does.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    model : Model
        The server's data model.
    server : int
        Pointer to the IedServer.
    attributes : Attributes
        The server's data attributes.
    """

    def __init__(self, lib: ctypes.CDLL, model: Model, server: int, attributes: Attributes) -> None:
        self._lib: Final = lib
        self._model: Final = model
        self._server: Final = server
        self._attributes: Final = attributes
        self._callbacks: list[object] = []
        self._readable: dict[int, ReadHandler] = {}

    def authenticate(self, authenticator: object) -> None:
        """Let an authenticator decide who may associate.

        Parameters
        ----------
        authenticator : object
            The callback for C.
        """
        self._callbacks.append(authenticator)
        self._lib.IedServer_setAuthenticator(self._server, authenticator, None)

    def guard_files(self, guard: FileGuard) -> None:
        """Let a guard decide each file request.

        Parameters
        ----------
        guard : FileGuard
            The guard.
        """
        self._callbacks.append(install_file_guard(self._lib, self._server, guard))

    def on_operate(self, reference: str, handler: OperateHandler) -> None:
        """Set the handler for Operate of a data object.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO".
        handler : OperateHandler
            Decides about each Operate.
        """

        def operated(action: ControlAction) -> bool | AddCause:
            with self._attributes.held_by_library():
                return handler(action)

        node = self._model.node(reference, Node.DATA_OBJECT)
        model = self._attributes.read(f"{reference}.ctlModel")
        enhanced = model in (ControlModel.DIRECT_ENHANCED, ControlModel.SBO_ENHANCED)
        self._callbacks.append(
            install_operate_handler(self._lib, self._server, node, reference, operated, enhanced=enhanced)
        )

    def on_read(self, reference: str, handler: ReadHandler) -> None:
        """Set the handler that is asked before a data object is read.

        Parameters
        ----------
        reference : str
            Reference "LD/LN.DO".
        handler : ReadHandler
            Says whether it may be read.
        """
        if not self._readable:
            self._callbacks.append(install_read_handlers(self._lib, self._server, self._readable))
        self._readable[self._model.node(reference, Node.DATA_OBJECT)] = handler

    def clear(self) -> None:
        """Release the callbacks once the server has been destroyed."""
        self._callbacks.clear()
