"""A process that reads no objects from pickles: numbers, texts and their containers alone.

The library distributed unpickles what a scheduler sends, in every message and whatever its client is told to
accept. To unpickle an object is to call what the pickle names. Here nothing can be named but bytes.
"""

import _pickle
import io
import pickle
from collections.abc import Iterable
from typing import Any, Final, NoReturn

HARMLESS: Final = {("builtins", "bytes"): bytes}
"""What a pickle may name: distributed writes this type beside each text of octets."""


class ObjectRefusedError(TypeError):
    """A pickle holds an object, or is damaged. A TypeError, which distributed expects of such a pickle."""


class PlainUnpickler(pickle.Unpickler):
    """Reads what is made of None, numbers, texts, bytes, lists, tuples, sets and dicts."""

    def find_class(self, module: str, name: str) -> type[bytes]:
        """Refuse whatever else a pickle names."""
        if (module, name) not in HARMLESS:
            raise ObjectRefusedError(f"a pickle names {module}.{name}: expected plain data")
        return HARMLESS[module, name]

    def persistent_load(self, pid: object) -> NoReturn:
        """Refuse what lies outside the pickle."""
        raise ObjectRefusedError(f"a pickle names something outside it, {pid!r}: expected plain data")


def load(
    file: Any,
    *,
    fix_imports: bool = True,
    encoding: str = "ASCII",
    errors: str = "strict",
    buffers: Iterable[Any] | None = (),
) -> Any:
    """Read plain data from a file, as pickle.load does. Raises ObjectRefusedError."""
    reader = PlainUnpickler(file, fix_imports=fix_imports, encoding=encoding, errors=errors, buffers=buffers)
    try:
        return reader.load()
    except ObjectRefusedError:
        raise
    except Exception as error:  # a damaged pickle ends in any
        raise ObjectRefusedError(f"a damaged pickle: {error}") from error


def loads(data: Any, /, **options: Any) -> Any:
    """Read plain data from bytes, as pickle.loads does. Raises ObjectRefusedError."""
    return load(io.BytesIO(data), **options)


def refuse_objects() -> None:
    """Have this process read plain data alone from pickles, from now on.

    To be called before anything is imported that takes these functions for itself.
    """
    for module in (pickle, _pickle):
        for name, value in (("load", load), ("loads", loads), ("Unpickler", PlainUnpickler)):
            setattr(module, name, value)
    for name, value in (("_load", load), ("_loads", loads), ("_Unpickler", PlainUnpickler)):
        setattr(pickle, name, value)
