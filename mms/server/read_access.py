"""Data objects of a server that cannot be read at times."""

import ctypes
from collections.abc import Callable

from mms.binding.callbacks import guarded
from mms.binding.prototypes import ReadAccessHandler
from mms.values import DataAccessError

_SUCCESS = -1  # DATA_ACCESS_ERROR_SUCCESS

ReadHandler = Callable[[], DataAccessError | None]
"""Tells why a data object cannot be read at present, None where it can."""


def install_read_handlers(lib: ctypes.CDLL, server: int, handlers: dict[int, ReadHandler]) -> object:
    """Ask a handler before a data object is read. A logical node as a whole stays readable.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    server : int
        Pointer to the IedServer.
    handlers : dict of int to ReadHandler
        Handlers by pointer to the data object. It may grow later.

    Returns
    -------
    object
        The ctypes callback, to be held for as long as the server lives.
    """

    def asked(
        _device: int | None,
        _node: int | None,
        data_object: int | None,
        _constraint: int,
        _connection: int | None,
        _parameter: int | None,
    ) -> int:
        handler = None if data_object is None else handlers.get(data_object)
        error = None if handler is None else handler()
        return _SUCCESS if error is None else error.value

    callback = ReadAccessHandler(guarded(asked, _SUCCESS))
    lib.IedServer_setReadAccessHandler(server, callback, None)
    return callback
