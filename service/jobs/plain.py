"""What a worker found, as plain JSON, and back: the types here say what may be in it, not the text.

A pickle names the functions that are called to read it, so whoever writes one runs what they like in its
reader. Here the reader looks for the fields it knows, and each has to be of its declared type.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from types import NoneType, UnionType
from typing import Any, Final, Literal, Union, cast, get_args, get_origin, get_type_hints

from core.error_words import one_line
from service.jobs.dask_tasks import MOST_CHARACTERS
from service.jobs.task import Diagnosed, Outcome, Rejected
from service.jobs.workers import WorkerFailedError
from service.recording_store.errors import StoreUnreachableError

LONGEST_REASON: Final = 1000

_KINDS: Final[dict[str, type]] = {"diagnosed": Diagnosed, "rejected": Rejected}
_FAILED, _STORE_UNREACHABLE = "failed", "store-unreachable"
_UNIONS = (Union, UnionType)


class PlainDataError(ValueError):
    """A text is not what is expected of a worker; it says where."""


def outcome_text(find: Callable[[], Outcome]) -> str:
    """Do a worker's task, and return the text of what came of it, be it an error."""
    try:
        outcome = find()
        kind = next(name for name, cls in _KINDS.items() if isinstance(outcome, cls))
        return json.dumps({kind: plain(outcome)})
    except StoreUnreachableError as error:
        return json.dumps({_STORE_UNREACHABLE: str(error)})
    except Exception as error:  # noqa: BLE001 - the service is told of every one
        return json.dumps({_FAILED: f"{type(error).__name__}: {error}"})


def read_outcome(text: str) -> Outcome:
    """Return what a worker found. Raises PlainDataError, and what the worker failed with.

    The latter are WorkerFailedError and StoreUnreachableError.
    """
    if len(text) > MOST_CHARACTERS:
        raise PlainDataError(f"expected {MOST_CHARACTERS} characters at most, found {len(text)}")
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise PlainDataError(f"expected JSON, found something else: {error}") from error
    if not isinstance(document, dict) or len(document) != 1:
        raise PlainDataError("expected an object with one key")
    ((kind, content),) = document.items()
    if kind in _KINDS:
        return cast("Outcome", read(content, _KINDS[kind], kind))
    if kind not in {_FAILED, _STORE_UNREACHABLE} or not isinstance(content, str):
        raise PlainDataError(f"expected diagnosed, rejected or a failure, found {one_line(kind)[:60]}")
    reason = one_line(content)[:LONGEST_REASON]
    raise StoreUnreachableError(reason) if kind == _STORE_UNREACHABLE else WorkerFailedError(reason)


def plain(value: object) -> object:
    """Return what JSON can hold of a value: dataclasses by their fields, sets and mappings as lists."""
    if isinstance(value, Enum):
        return value.value
    if is_dataclass(value):
        return {one.name: plain(getattr(value, one.name)) for one in fields(value)}
    if isinstance(value, Mapping):
        return [[plain(key), plain(one)] for key, one in value.items()]
    if isinstance(value, frozenset):
        return sorted(map(plain, value), key=str)
    if isinstance(value, tuple):
        return [plain(one) for one in value]
    if isinstance(value, complex) and not isinstance(value, float):
        return [value.real, value.imag]
    return value


def read(document: object, hint: Any, way: str) -> object:
    """Return the value of a type that a document holds. Raises PlainDataError, which says what is wrong."""
    origin = get_origin(hint)
    if origin in _UNIONS:
        return _of_union(document, get_args(hint), way)
    if origin is Literal:
        if not any(document == one and type(document) is type(one) for one in get_args(hint)):
            raise _wrong(way, f"one of {get_args(hint)}", document)
        return document
    if origin is tuple:
        return _of_tuple(document, get_args(hint), way)
    if origin is frozenset:
        (kind,) = get_args(hint)
        return frozenset(read(one, kind, way) for one in _listed(document, way))
    if origin is not None and issubclass(origin, Mapping):
        return _of_mapping(document, get_args(hint), way)
    if is_dataclass(hint):
        return _of_dataclass(document, cast("type", hint), way)
    if isinstance(hint, type) and issubclass(hint, Enum):
        if not isinstance(document, str) or document not in {one.value for one in hint}:
            raise _wrong(way, f"a {hint.__name__}", document)
        return hint(document)
    return _of_simple(document, hint, way)


def _of_simple(document: object, hint: Any, way: str) -> object:
    if hint is complex:
        parts = [read(one, float, way) for one in _listed(document, way)]
        if len(parts) != 2:
            raise _wrong(way, "two numbers", document)
        return complex(*cast("list[float]", parts))
    found = type(document)
    if found is hint or (hint is float and found is int):
        return document
    if hint in {bool, int, float, str}:
        raise _wrong(way, f"a {hint.__name__}", document)
    raise TypeError(f"{way}: no rule to read {hint}")


def _of_union(document: object, kinds: tuple[Any, ...], way: str) -> object:
    """Return a value that may be None. No other unions are known here."""
    if document is None and NoneType in kinds:
        return None
    (kind,) = (one for one in kinds if one is not NoneType)
    return read(document, kind, way)


def _of_tuple(document: object, kinds: tuple[Any, ...], way: str) -> object:
    parts = _listed(document, way)
    if len(kinds) == 2 and kinds[1] is Ellipsis:
        kinds = (kinds[0],) * len(parts)
    if len(parts) != len(kinds):
        raise _wrong(way, f"{len(kinds)} values", document)
    return tuple(
        read(one, kind, f"{way}[{place}]") for place, (one, kind) in enumerate(zip(parts, kinds, strict=True))
    )


def _of_mapping(document: object, kinds: tuple[Any, ...], way: str) -> object:
    pairs = [_of_tuple(pair, kinds, way) for pair in _listed(document, way)]
    found = dict(cast("list[tuple[object, object]]", pairs))
    if len(found) != len(pairs):
        raise _wrong(way, "each key once", document)
    return found


def _of_dataclass(document: object, cls: type, way: str) -> object:
    hints = _hints(cls)
    if not isinstance(document, dict) or document.keys() != hints.keys():
        raise _wrong(way, f"the fields {', '.join(hints)}", document)
    return cls(**{name: read(document[name], hint, f"{way}.{name}") for name, hint in hints.items()})


@cache
def _hints(cls: type) -> dict[str, Any]:
    hints = get_type_hints(cls)
    return {one.name: hints[one.name] for one in fields(cls)}


def _listed(document: object, way: str) -> list[object]:
    if not isinstance(document, list):
        raise _wrong(way, "a list", document)
    return document


def _wrong(way: str, expected: str, found: object) -> PlainDataError:
    return PlainDataError(f"{way}: expected {expected}, found {one_line(repr(found))[:60]}")
