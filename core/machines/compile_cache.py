"""The machine code that numba keeps beside the source, and when it is no longer that of the source."""

import re
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

from numba.core.caching import FunctionCache

IMPORT: Final = re.compile(r"^from ([A-Za-z_][\w.]*) import ([\w, ]*)", re.MULTILINE)


class ProgramCache(FunctionCache):  # type: ignore[misc]  # numba has no types
    """A cache that notices a change in all modules that a function's module imports.

    numba looks at the file of the function alone. What it has compiled holds the functions that it calls as
    they were, and would be taken for theirs after an update that changes these only.

    Parameters
    ----------
    function : callable
        The function.
    """

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        module = function.__module__
        root = Path(function.__code__.co_filename).parents[module.count(".")]
        self._cache_file._source_stamp = source_stamp(root, module)  # noqa: SLF001  # numba has no other way


@lru_cache(maxsize=256)
def source_stamp(root: Path, module: str) -> bytes:
    """Return what changes with a module or any that it imports.

    Parameters
    ----------
    root : Path
        Folder of the top package. Modules that are not below it are not looked at.
    module : str
        Name of the module.

    Returns
    -------
    bytes
        Digest of all their files.
    """
    found: dict[str, bytes] = {}
    pending = [module]
    while pending:
        name = pending.pop()
        content = _content(root, name)
        if name not in found and content is not None:
            found[name] = content
            for package, names in IMPORT.findall(content.decode()):
                pending += [
                    package,
                    *(f"{package}.{each.strip()}" for each in names.split(",") if each.strip()),
                ]
    digest = sha256()
    for name in sorted(found):
        digest.update(name.encode() + b"\0" + found[name] + b"\0")
    return digest.digest()


@lru_cache(maxsize=1024)
def _content(root: Path, module: str) -> bytes | None:
    path = root.joinpath(*module.split("."))
    for file in (path.with_suffix(".py"), path / "__init__.py"):
        if file.is_file():
            return file.read_bytes()
    return None
