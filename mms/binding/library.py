"""The libiec61850 shared library bundled in the pyiec61850-ng wheel, loaded through ctypes.

The wheel's SWIG module is never imported: it holds the interpreter lock through blocking calls and deadlocks
when a report arrives meanwhile. ctypes releases the lock for the length of every call.
"""

import ctypes
import functools
import importlib.util
import mmap
import re
from pathlib import Path

from mms.binding.prototypes import PROTOTYPES

_WHEEL = "pyiec61850-ng"
_MBED_TLS_SOURCES = re.compile(rb"mbedtls-([0-9]+\.[0-9]+\.[0-9]+)/library/")


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


def mbed_tls_version() -> str | None:
    """Find out which version of Mbed TLS the library works with.

    Some builds can be asked. Others have the paths of their source files in them, which name it.

    Returns
    -------
    str or None
        The version, such as "3.6.0"; None where the library does not tell it.

    Raises
    ------
    ImportError
        The library cannot be found or lacks a function.
    """
    try:
        ask = library().mbedtls_version_get_number
    except AttributeError:
        return _mbed_tls_named_in(shared_library())
    ask.restype, ask.argtypes = ctypes.c_uint, []
    number = int(ask())
    return f"{number >> 24}.{number >> 16 & 0xFF}.{number >> 8 & 0xFF}"


def _mbed_tls_named_in(file: Path) -> str | None:
    """Return the one version that the paths of source files in a library name."""
    with file.open("rb") as opened, mmap.mmap(opened.fileno(), 0, access=mmap.ACCESS_READ) as content:
        found = set(_MBED_TLS_SOURCES.findall(content))
    return found.pop().decode("ascii") if len(found) == 1 else None
