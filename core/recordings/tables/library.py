"""Libraries for tables that are no part of a plain installation, and their errors for damaged files."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from types import ModuleType

from core.error_words import one_line
from core.recordings.errors import RecordingError

EXTRA = "pip install 'statorwatch[tables]'"


def library(path: Path, module: str, form: str) -> ModuleType:
    """Import a library when a file needs it.

    Parameters
    ----------
    path : pathlib.Path
        The file, for messages.
    module : str
        Name of the module.
    form : str
        What the file is, in words.

    Returns
    -------
    module
        The module.

    Raises
    ------
    RecordingError
        If it is not installed.
    """
    try:
        return import_module(module)
    except ImportError as error:
        name = module.partition(".")[0]
        expected = f"the library {name}, which reads {form}: {EXTRA}"
        raise RecordingError(path, "file", expected=expected, found="it is not installed here") from error


@contextmanager
def refusing_damage(path: Path, form: str) -> Iterator[None]:
    """Turn whatever a library raises for a damaged file into one error.

    Parameters
    ----------
    path : pathlib.Path
        The file, for messages.
    form : str
        What it is expected to be, in words.

    Yields
    ------
    None
        For the reading of the file.

    Raises
    ------
    RecordingError
        If the library cannot read it.
    """
    try:
        yield
    except RecordingError:
        raise
    except Exception as error:  # damaged octets make these libraries raise errors of any kind
        told = one_line(str(error))[:200] or type(error).__name__
        raise RecordingError(
            path, "file", expected=form, found=f"a damaged or another one: {told}"
        ) from error
