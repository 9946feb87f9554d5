"""The libiec61850 shared library bundled in the pyiec61850-ng wheel, loaded through ctypes.

The wheel's SWIG module is never imported: it holds the interpreter lock through blocking calls and deadlocks
when a report arrives meanwhile. ctypes releases the lock for the length of every call.
"""

import ctypes
import functools
import importlib.util
from pathlib import Path

from mms.binding.prototypes import PROTOTYPES

_WHEEL = "pyiec61850-ng"


def shared_library() -> Path:
    """Find the shared library in the wheel.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    ImportError
        The wheel is not installed, or has not exactly one such file.
    """
    spec = importlib.util.find_spec("pyiec61850")
    if spec is None or not spec.submodule_search_locations:
        raise ImportError(f"the package {_WHEEL} is not installed: it carries the MMS library")
    folder = Path(spec.submodule_search_locations[0]).parent / "pyiec61850_ng.libs"
    found = sorted(folder.glob("libiec61850*.so*"))
    if len(found) != 1:
        raise ImportError(f"expected one libiec61850*.so in {folder.name} of {_WHEEL}, found {len(found)}")
    return found[0]


@functools.cache
def library() -> ctypes.CDLL:
    """Load the library, with result and argument types declared for every function used here.

    Returns
    -------
    ctypes.CDLL
        The library, the same object at each call.

    Raises
    ------
    ImportError
        The library cannot be found or lacks a function.
    """
    loaded = ctypes.CDLL(str(shared_library()))
    for name, (result, arguments) in PROTOTYPES.items():
        try:
            function = getattr(loaded, name)
        except AttributeError as error:
            raise ImportError(f"{_WHEEL} has no function {name}: expected version 1.6.1") from error
        function.restype = result
        function.argtypes = arguments
    return loaded
