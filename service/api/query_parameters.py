"""Query parameters that a route does not have are refused: a misspelt one would silently select nothing."""

from collections import Counter
from collections.abc import Callable, Mapping
from http import HTTPStatus
from itertools import islice
from typing import get_args, get_origin
from weakref import WeakKeyDictionary

from fastapi import Request, params
from fastapi.dependencies.utils import get_flat_params
from fastapi.routing import APIRoute

from core.error_words import nearest
from service.api.problems import MAX_ERRORS, FieldError, ProblemError, location

LONGEST_QUOTED = 100

_PARAMETERS: WeakKeyDictionary[Callable[..., object], Mapping[str, bool]] = WeakKeyDictionary()
"""Of the functions of routes, which are read once: see `_known`."""


async def refuse_unknown_parameters(request: Request) -> None:
    """Raise ProblemError (422) for a query parameter that the route does not have, or that is given twice.

    One that takes a list may be given several times.
    """
    if not request.query_params:
        return
    known = _known(request)
    given_times = Counter(name for name, _ in request.query_params.multi_items())
    faulty = (
        FieldError(location=location(("query", name)), message=_fault(name, known))
        for name, times in given_times.items()
        if name not in known or (times > 1 and not known[name])
    )
    errors = list(islice(faulty, MAX_ERRORS))
    if errors:
        detail = "; ".join(f"{error.location}: {error.message}" for error in errors[:3])
        raise ProblemError(HTTPStatus.UNPROCESSABLE_ENTITY, detail[:1000], errors=errors)


def _known(request: Request) -> Mapping[str, bool]:
    """Return the query parameters of the route that answers, and whether each takes a list."""
    route = request.scope["route"]
    if not isinstance(route, APIRoute):
        return {}
    known = _PARAMETERS.get(route.endpoint)
    if known is None:
        known = _PARAMETERS[route.endpoint] = {
            field.alias: _is_list(field.field_info.annotation)
            for field in get_flat_params(route.dependant)
            if isinstance(field.field_info, params.Query)
        }
    return known


def _is_list(annotation: object) -> bool:
    return get_origin(annotation) is list or any(map(_is_list, get_args(annotation)))


def _fault(name: str, known: Mapping[str, bool]) -> str:
    if name in known:
        return "expected it once, found it several times"
    quoted = ascii(name[:LONGEST_QUOTED])
    if not known:
        return f"there is no parameter {quoted} here, nor any other"
    near = nearest(name[:LONGEST_QUOTED], known)
    hint = "" if near is None else f"; did you mean {near!r}?"
    return f"there is no parameter {quoted} here{hint} (known: {', '.join(known)})"
