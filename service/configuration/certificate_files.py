"""The files with certificates that the settings name, and what uses each."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from pydantic import BaseModel

CERTIFICATES = frozenset(("certificate", "tls_certificate", "ca", "pinned"))
"""Settings of these names, wherever they stand, are files with certificates."""


def certificate_files(settings: BaseModel) -> Mapping[Path, Sequence[str]]:
    """Return the files with certificates that the settings name, each with what uses it."""
    files: dict[Path, list[str]] = defaultdict(list)
    for keys, path in _named(settings, ()):
        user = _user(keys)
        if user not in files[path]:
            files[path].append(user)
    return files


def certificate_files_of(table: BaseModel) -> Sequence[Path]:
    """Return the files with certificates in one table of the settings, such as that of a relay."""
    return list(dict.fromkeys(path for _keys, path in _named(table, ())))


def _named(value: object, keys: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Path]]:
    """Yield each file with certificates in a part of the settings, with the keys that lead to it."""
    if isinstance(value, BaseModel):
        for name in type(value).model_fields:
            yield from _named(getattr(value, name), (*keys, name))
    elif isinstance(value, Mapping):
        for name, part in value.items():
            yield from _named(part, (*keys, str(name)))
    elif isinstance(value, tuple | list):
        for part in value:
            yield from _named(part, keys)
    elif isinstance(value, Path) and keys[-1] in CERTIFICATES:
        yield keys, value


def _user(keys: tuple[str, ...]) -> str:
    """Return in words what uses a file."""
    if keys[0] == "relays":
        return f"relay {keys[1]}"
    return "the REST API" if len(keys) == 1 else f"[{'.'.join(keys[:-1])}]"
