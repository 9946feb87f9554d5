"""What a worker found, as plain JSON, and back: the types here say what may be in it, not the text.

A pickle names the functions that are called to read it, so whoever writes one runs what they like in its
reader. Here the reader looks for the fields it knows, and each has to be of its declared type.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import ClassVar, Final

from pydantic import ConfigDict, TypeAdapter, ValidationError

from core.error_words import one_line
from service.jobs.dask_tasks import MOST_CHARACTERS
from service.jobs.task import Diagnosed, Outcome, Rejected
from service.jobs.workers import WorkerFailedError
from service.recording_store.errors import StoreUnreachableError

LONGEST_REASON: Final = 1000


class PlainDataError(ValueError):
    """A text is not what is expected of a worker; it says where."""


@dataclass(frozen=True, slots=True)
class _Answer:
    """What came of a task: one of these, and nothing of the others."""

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(
        extra="forbid", strict=True, ser_json_inf_nan="constants"
    )

    diagnosed: Diagnosed | None = None
    rejected: Rejected | None = None
    failed: str | None = None
    store_unreachable: str | None = None


def outcome_text(find: Callable[[], Outcome]) -> str:
    """Do a worker's task, and return the text of what came of it, be it an error."""
    try:
        outcome = find()
        if isinstance(outcome, Rejected):
            return _text(_Answer(rejected=outcome))
        return _text(_Answer(diagnosed=outcome))
    except StoreUnreachableError as error:
        return _text(_Answer(store_unreachable=str(error)))
    except Exception as error:  # noqa: BLE001 - the service is told of every one
        return _text(_Answer(failed=f"{type(error).__name__}: {error}"))


def read_outcome(text: str) -> Outcome:
    """Return what a worker found. Raises PlainDataError, and what the worker failed with.

    The latter are WorkerFailedError and StoreUnreachableError.
    """
    if len(text) > MOST_CHARACTERS:
        raise PlainDataError(f"expected {MOST_CHARACTERS} characters at most, found {len(text)}")
    try:
        answer = _adapter().validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        way = ".".join(map(str, first["loc"])) or "answer"
        found = one_line(repr(first["input"]))[:60]
        raise PlainDataError(f"{way}: {one_line(first['msg'])}, found {found}") from error
    if answer.store_unreachable is not None:
        raise StoreUnreachableError(one_line(answer.store_unreachable)[:LONGEST_REASON])
    if answer.failed is not None:
        raise WorkerFailedError(one_line(answer.failed)[:LONGEST_REASON])
    outcome = answer.diagnosed or answer.rejected
    if outcome is None:
        raise PlainDataError("expected diagnosed, rejected or a failure, found none of them")
    return outcome


@cache
def _adapter() -> TypeAdapter[_Answer]:
    return TypeAdapter(_Answer)


def _text(answer: _Answer) -> str:
    return _adapter().dump_json(answer, exclude_defaults=True).decode()
