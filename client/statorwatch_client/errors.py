"""What can go wrong between a client and a service."""

import re
from typing import TYPE_CHECKING

import httpx

if TYPE_CHECKING:
    from statorwatch_client.models import Problem

PART_OF_REQUEST = re.compile(r"(^|; )(?:body|path|query)\.(?=\w+: )")
"""Where in an HTTP request a wrong value was says nothing to people; `Problem.errors` has it for programs."""


class ServiceError(RuntimeError):
    """The service did not do what it was asked. `status` is the HTTP status, None where it did not answer."""

    def __init__(self, message: str, *, status: int | None = None) -> None:
        super().__init__(message)
        self.status = status


class ProblemError(ServiceError):
    """The service refused, and told why: `problem` is its problem document (RFC 9457).

    retry_after_s: after so many seconds it may be asked again; None where it does not say so.
    """

    def __init__(self, message: str, problem: "Problem", *, status: int, retry_after_s: int | None) -> None:
        super().__init__(message, status=status)
        self.problem = problem
        self.retry_after_s = retry_after_s


def refusal(response: httpx.Response) -> ServiceError:
    """Return the error that tells what an answer other than success says.

    Parameters
    ----------
    response
        The answer, read to its end.
    """
    status = response.status_code
    try:
        problem = response.json()
    except ValueError:
        problem = None
    if not isinstance(problem, dict):
        return ServiceError(f"{asked(response)}: HTTP status {status}", status=status)
    detail = str(problem.get("detail") or problem.get("title") or f"HTTP status {status}")
    told = response.headers.get("Retry-After", "")
    whole: Problem = {"type": "about:blank", "title": "", "status": status, "detail": detail, "instance": ""}
    whole.update(problem)  # type: ignore[typeddict-item]  # what a service says is what its document promises
    return ProblemError(
        PART_OF_REQUEST.sub(r"\1", detail),
        whole,
        status=status,
        retry_after_s=int(told) if told.isdecimal() else None,
    )


def asked(response: httpx.Response) -> str:
    """Return the address that was asked, without a password that may stand in it."""
    return without_credentials(str(response.url))


def without_credentials(url: str) -> str:
    """Return a URL as it may be printed: without what is before its last @, where a password may stand."""
    return re.sub(r"(//|^).*@", r"\1", url, count=1, flags=re.DOTALL)
