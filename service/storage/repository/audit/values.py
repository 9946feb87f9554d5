"""What an entry keeps of a change: values before and after as JSON, and never a secret."""

import math
import re
from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Final

from service.audit.entries import canonical
from service.storage.texts import storable

NOT_KEPT: Final = "(not kept)"
"""What stands for a secret."""

_SECRET = re.compile(r"passw|secret|token|credential|authorization|cookie|private_key|hash$", re.IGNORECASE)


def kept(values: Mapping[str, object] | None) -> str | None:
    """Return values as canonical JSON; None for None. What has the name of a secret is not kept."""
    return None if values is None else canonical(_mapping(values))


def changed(
    before: Mapping[str, object], after: Mapping[str, object]
) -> tuple[dict[str, object], dict[str, object]]:
    """Return those values that differ, as they were and as they are; one that is missing is null."""
    names = [name for name in (*before, *after) if before.get(name) != after.get(name)]
    return {name: before.get(name) for name in names}, {name: after.get(name) for name in names}


def _mapping(values: Mapping[str, object]) -> dict[str, object]:
    return {
        storable(name): NOT_KEPT if _SECRET.search(name) and value is not None else _value(value)
        for name, value in values.items()
    }


def _value(value: object) -> object:
    match value:
        case Enum():
            return _value(value.value)
        case None | bool() | int():
            return value
        case float():
            return value if math.isfinite(value) else repr(value)
        case str():
            return storable(value)
        case Mapping():
            return _mapping({str(name): each for name, each in value.items()})
        case Sequence() | set() | frozenset():
            return [_value(each) for each in (value if isinstance(value, Sequence) else sorted(value))]
    return storable(str(value))
