"""Every error is a problem document (RFC 9457, application/problem+json), whoever raised it."""

from collections.abc import Callable, Iterable, Mapping
from http import HTTPStatus
from typing import Annotated, Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field
from sqlalchemy.exc import (
    DataError,
    OperationalError,
    SQLAlchemyError,
    TimeoutError,  # noqa: A004 - that of the database
)
from starlette.exceptions import HTTPException
from starlette.routing import Match
from structlog.typing import FilteringBoundLogger

from service.access.logins import LoginLockedError
from service.process.disk_space import is_disk_full
from service.process.sealing import SealError
from service.recording_store.errors import RecordingStoreError, StoreError
from service.storage.errors import (
    AlarmActionError,
    AlarmCannotGrowError,
    AuditorAccountError,
    DeletionStaysError,
    DoubtfulBaselineError,
    FolderGoneError,
    LastAdministratorError,
    LastFactorError,
    NotFoundError,
    NotOwnPasswordError,
    OutOfServiceError,
    PasskeyExistsError,
    PasswordOfAnotherError,
    RecordingInUseError,
    RolesNotSeparateError,
    StateConflictError,
    TokenOfAnotherError,
    TooManyInspectionsError,
    TooManyNotesError,
    TooManyTestsError,
    TooManyTokensError,
    TooManyWaitingError,
    UnusableBaselineError,
    UserExistsError,
    WiderTokenError,
)
from service.timing.database_silence import does_not_answer

log: FilteringBoundLogger = structlog.get_logger(__name__)

MEDIA_TYPE = "application/problem+json"

STATUS_OF: dict[type[Exception], HTTPStatus] = {
    NotFoundError: HTTPStatus.NOT_FOUND,
    UnusableBaselineError: HTTPStatus.CONFLICT,
    OutOfServiceError: HTTPStatus.CONFLICT,
    StateConflictError: HTTPStatus.CONFLICT,
    TooManyNotesError: HTTPStatus.CONFLICT,
    TooManyInspectionsError: HTTPStatus.CONFLICT,
    RecordingInUseError: HTTPStatus.CONFLICT,
    DeletionStaysError: HTTPStatus.CONFLICT,
    AlarmActionError: HTTPStatus.CONFLICT,
    AlarmCannotGrowError: HTTPStatus.CONFLICT,
    LastFactorError: HTTPStatus.CONFLICT,
    PasskeyExistsError: HTTPStatus.CONFLICT,
    UserExistsError: HTTPStatus.CONFLICT,
    LastAdministratorError: HTTPStatus.CONFLICT,
    TooManyTokensError: HTTPStatus.CONFLICT,
    RolesNotSeparateError: HTTPStatus.CONFLICT,
    NotOwnPasswordError: HTTPStatus.CONFLICT,
    AuditorAccountError: HTTPStatus.FORBIDDEN,
    PasswordOfAnotherError: HTTPStatus.FORBIDDEN,
    TokenOfAnotherError: HTTPStatus.FORBIDDEN,
    WiderTokenError: HTTPStatus.CONFLICT,
}
"""The HTTP status that answers each refusal of the storage."""

RETRY_AFTER_S = 5
"""Clients are told to wait this long while the database does not answer (a full disk, a long lock)."""

RETRY_WHEN_FULL_S = 60
"""Clients are told to wait this long while a motor's queue is full."""

METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE")

OF_ALL = (
    HTTPStatus.UNAUTHORIZED,
    HTTPStatus.FORBIDDEN,
    HTTPStatus.UNPROCESSABLE_ENTITY,
    HTTPStatus.SERVICE_UNAVAILABLE,
)


MAX_ERRORS = 100
"""An answer names so many faults of a request."""

MAX_LOCATION_LENGTH = 200

LONGEST_QUOTED = 50
"""An answer repeats so much of a wrong value."""


class FieldError(BaseModel):
    """What is wrong with one part of a request; `location` is the way to it, "query.limit"."""

    location: str
    message: str


class Problem(BaseModel):
    """RFC 9457 problem details.

    errors: what is wrong with which part of the request. parts: of the service, for readiness.
    """

    type: str = "about:blank"
    title: str
    status: int
    detail: str
    instance: str
    errors: Annotated[list[FieldError], Field(max_length=MAX_ERRORS)] | None = None
    parts: dict[str, str] | None = None


class ProblemError(Exception):
    """An answer other than success, from within a route."""

    def __init__(self, status: HTTPStatus, detail: str, *, errors: list[FieldError] | None = None) -> None:
        self.status = status
        self.detail = detail
        self.errors = errors
        super().__init__(detail)


class WrongFieldError(ProblemError):
    """One part of a request is not as it has to be; `location` is the way to it, "query.limit"."""

    def __init__(self, location: str, message: str) -> None:
        errors = [FieldError(location=location, message=message)]
        super().__init__(HTTPStatus.UNPROCESSABLE_ENTITY, f"{location}: {message}", errors=errors)


class BusyError(Exception):
    """There was no turn within the time one may wait."""

    def __init__(self, what: str, most: int) -> None:
        super().__init__(f"{most} {what} are under way, and none came to its end in time")


def problems(*statuses: int) -> dict[int | str, dict[str, object]]:
    """Return OpenAPI's description of a route's errors, and of those that any route may have."""
    return {
        int(status): {
            "description": HTTPStatus(status).phrase,
            "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}},
        }
        for status in (*statuses, *OF_ALL)
    }


def problem_response(
    path: str,
    status: int,
    detail: str,
    *,
    errors: list[FieldError] | None = None,
    parts: dict[str, str] | None = None,
    headers: Mapping[str, str] | None = None,
) -> JSONResponse:
    problem = Problem(
        title=HTTPStatus(status).phrase,
        status=status,
        detail=detail,
        instance=path,
        errors=errors,
        parts=parts,
    )
    return JSONResponse(
        problem.model_dump(exclude_none=True),
        status_code=status,
        headers=dict(headers or {}),
        media_type=MEDIA_TYPE,
    )


def busy_response(path: str, reason: str) -> JSONResponse:
    """Return the answer to what would be more work at once than the service takes on."""
    return problem_response(
        path,
        HTTPStatus.SERVICE_UNAVAILABLE,
        f"{reason}; nothing was changed, try again",
        headers={"Retry-After": str(RETRY_AFTER_S)},
    )


def database_response(path: str, error: SQLAlchemyError) -> JSONResponse:
    """Return the answer where the database does not answer, or refuses what it is asked."""
    if not does_not_answer(error):
        return _failed(path, error)
    reason = str(error.orig) if isinstance(error, OperationalError) else str(error)
    log.error("database does not answer", path=path, error=reason)
    return problem_response(
        path,
        HTTPStatus.SERVICE_UNAVAILABLE,
        f"the database does not answer ({reason}); nothing was changed, try again",
        headers={"Retry-After": str(RETRY_AFTER_S)},
    )


def _failed(path: str, error: Exception) -> JSONResponse:
    log.error("request failed", path=path, exc_info=error)
    detail = "the service failed to answer; its log says why"
    return problem_response(path, HTTPStatus.INTERNAL_SERVER_ERROR, detail)


def _too_many(request: Request, error: Exception) -> JSONResponse:
    return problem_response(
        request.url.path,
        HTTPStatus.TOO_MANY_REQUESTS,
        str(error),
        headers={"Retry-After": str(RETRY_WHEN_FULL_S)},
    )


def _locked(request: Request, error: Exception) -> JSONResponse:
    """Return the answer to a login after too many that failed. Raises any other error again."""
    if not isinstance(error, LoginLockedError):
        raise error
    headers = {"Retry-After": str(error.retry_after_s)}
    return problem_response(request.url.path, HTTPStatus.TOO_MANY_REQUESTS, str(error), headers=headers)


def _with_status(status: HTTPStatus) -> Callable[[Request, Exception], JSONResponse]:
    def answer(request: Request, error: Exception) -> JSONResponse:
        return problem_response(request.url.path, status, str(error))

    return answer


def _unstorable(request: Request, error: Exception) -> JSONResponse:
    """Return the answer to a value that cannot be stored, e.g. a NUL, which PostgreSQL cannot hold."""
    detail = f"the database cannot hold a value of this request: {getattr(error, 'orig', error)}"
    return problem_response(request.url.path, HTTPStatus.UNPROCESSABLE_ENTITY, detail)


def _busy(request: Request, error: Exception) -> JSONResponse:
    return busy_response(request.url.path, str(error))


def _doubtful(request: Request, error: Exception) -> JSONResponse:
    """Return the answer to a baseline of recordings in doubt. Raises any other error again."""
    if not isinstance(error, DoubtfulBaselineError):
        raise error
    errors = [
        FieldError(location=f"body.recording_ids.{each.recording_id}", message=each.doubt)
        for each in error.doubts[:MAX_ERRORS]
    ]
    return problem_response(request.url.path, HTTPStatus.CONFLICT, str(error), errors=errors)


def _full(request: Request, error: Exception) -> JSONResponse:
    """Return the answer to what found no room on a disk. Raises any other error again."""
    if not is_disk_full(error):
        raise error
    log.error("the disk is full", path=request.url.path, error=str(error.__cause__ or error))
    return busy_response(request.url.path, "there is no room on the disk")


def _methods(request: Request) -> list[str]:
    """Return the methods that the path of a request has, on whatever routes."""
    return [
        method
        for method in METHODS
        if any(
            route.matches({**request.scope, "method": method})[0] is Match.FULL
            for route in request.app.routes
        )
    ]


def location(way: Iterable[str | int]) -> str:
    """Return the way to a fault; names in it come from the client, and may be long or no proper text."""
    text = ".".join(str(part)[:MAX_LOCATION_LENGTH] for part in way)[:MAX_LOCATION_LENGTH]
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _in_words(found: Mapping[str, Any]) -> str:
    """Return what is wrong with a value, in words for those who do not know the program's types."""
    given = found.get("ctx", {})
    match found["type"]:
        case "uuid_parsing" | "uuid_type" | "uuid_version":
            text = repr(str(found["input"])[:LONGEST_QUOTED]).encode("ascii", "backslashreplace").decode()
            return f"expected an id such as mcc recordings list shows, found {text}"
        case "too_short":
            kind = "different ones" if given.get("field_type") == "Set" else "of them"
            return f"expected at least {given['min_length']} {kind}, found {given['actual_length']}"
    return str(found["msg"]).removeprefix("Value error, ")  # the name of an exception of Python


def _sealed(request: Request, error: Exception) -> JSONResponse:
    log.error("a secret cannot be opened", path=request.url.path, error=str(error))
    return problem_response(request.url.path, HTTPStatus.SERVICE_UNAVAILABLE, str(error))


def install(app: FastAPI) -> None:
    """Make `app` answer every error with a problem document."""

    @app.exception_handler(ProblemError)
    def _problem(request: Request, error: ProblemError) -> JSONResponse:
        return problem_response(request.url.path, error.status, error.detail, errors=error.errors)

    @app.exception_handler(HTTPException)
    def _http(request: Request, error: HTTPException) -> JSONResponse:
        detail = error.detail
        if error.status_code == HTTPStatus.NOT_FOUND:
            detail = f"nothing is at {request.url.path}; /api/v1/openapi.json says what there is"
        if error.status_code == HTTPStatus.METHOD_NOT_ALLOWED:
            detail = f"{request.method} is not possible here"
            headers = {"Allow": ", ".join(_methods(request))}
            return problem_response(request.url.path, error.status_code, detail, headers=headers)
        if is_disk_full(error):  # the parser of uploads, which go through the temporary folder
            return _full(request, error)
        return problem_response(request.url.path, error.status_code, detail, headers=error.headers)

    for error_type, status in STATUS_OF.items():
        app.add_exception_handler(error_type, _with_status(status))
    app.add_exception_handler(DataError, _unstorable)
    app.add_exception_handler(TooManyWaitingError, _too_many)
    app.add_exception_handler(TooManyTestsError, _too_many)
    app.add_exception_handler(BusyError, _busy)
    app.add_exception_handler(LoginLockedError, _locked)
    app.add_exception_handler(SealError, _sealed)
    app.add_exception_handler(DoubtfulBaselineError, _doubtful)
    app.add_exception_handler(FolderGoneError, _busy)
    app.add_exception_handler(OSError, _full)

    @app.exception_handler(StoreError)
    def _store(request: Request, error: StoreError) -> JSONResponse:
        log.error("the store of the recordings does not answer", path=request.url.path, error=str(error))
        return busy_response(request.url.path, str(error))

    @app.exception_handler(RecordingStoreError)
    def _damaged(request: Request, error: RecordingStoreError) -> JSONResponse:
        log.error("recording store is damaged", error=str(error))
        return problem_response(request.url.path, HTTPStatus.INTERNAL_SERVER_ERROR, str(error))

    @app.exception_handler(TimeoutError)
    @app.exception_handler(OperationalError)
    def _database(request: Request, error: OperationalError | TimeoutError) -> JSONResponse:
        return database_response(request.url.path, error)

    # On the event loop: what describes the faults would pile up in memory while it waits for a thread.
    @app.exception_handler(RequestValidationError)
    async def _validation(request: Request, error: RequestValidationError) -> JSONResponse:
        errors = [
            FieldError(location=location(found["loc"]), message=_in_words(found))
            for found in error.errors()[:MAX_ERRORS]
        ]
        detail = "; ".join(f"{found.location}: {found.message}" for found in errors[:3])
        return problem_response(
            request.url.path, HTTPStatus.UNPROCESSABLE_ENTITY, detail[:1000], errors=errors
        )

    @app.exception_handler(Exception)
    def _unexpected(request: Request, error: Exception) -> JSONResponse:
        return _failed(request.url.path, error)
