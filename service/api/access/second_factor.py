"""The second factor: set up, renewed and removed by its user, reset by who manages users."""

import time
from collections.abc import Sequence
from functools import partial
from http import HTTPStatus

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool

from service.access import second_factors
from service.access.permissions import Permission
from service.access.second_factors import FactorError, WrongCodeError
from service.api.access.callers import Asking, By, Caller
from service.api.access.requirements import require
from service.api.access.schemas import (
    FactorCode,
    OneTimeCode,
    OwnPassword,
    RecoveryCodes,
    TotpProposal,
    UserName,
)
from service.api.access.sessions import check_own_password, seal_of
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, WrongFieldError, problems

router = APIRouter(tags=["access"])


@router.post(
    "/account/totp",
    responses=problems(400, 404, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def propose_totp(
    context: Context, request: Request, asking: Asking, wanted: OwnPassword
) -> TotpProposal:
    """Return a new secret for an authenticator app, which counts once a code of it is sent back."""
    require_session(asking)
    await check_own_password(context, request, asking, wanted.password)
    made = await run_in_threadpool(
        lambda: second_factors.propose_totp(
            context.repository,
            seal_of(context),
            asking.actor.name,
            by=asking.actor,
            now_ns=time.time_ns(),
        )
    )
    return TotpProposal(secret=made.secret, uri=made.uri)


@router.post(
    "/account/totp/confirmation",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.ACCOUNT)],
)
def confirm_totp(context: Context, asking: Asking, wanted: FactorCode) -> RecoveryCodes:
    """Have the app count whose code this is, and return recovery codes, which are shown this once."""
    session = require_session(asking)
    try:
        codes = second_factors.confirm_totp(
            context.repository,
            seal_of(context),
            asking.actor.name,
            wanted.code,
            session=session,
            by=asking.actor,
            now_ns=time.time_ns(),
        )
    except WrongCodeError as error:
        raise WrongFieldError("body.code", str(error)) from error
    except FactorError as error:
        raise ProblemError(HTTPStatus.CONFLICT, str(error)) from error
    return RecoveryCodes(recovery_codes=list(codes))


@router.post(
    "/account/recovery-codes",
    responses=problems(400, 404, 409, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def make_recovery_codes(
    context: Context, request: Request, asking: Asking, wanted: OwnPassword
) -> RecoveryCodes:
    """Return other recovery codes, which are shown this once; the old ones count no more."""
    require_session(asking)
    await check_own_password(context, request, asking, wanted.password)
    codes = second_factors.new_recovery_codes()
    await run_in_threadpool(_keep_codes, context, asking, codes)
    return RecoveryCodes(recovery_codes=list(codes))


@router.post(
    "/account/second-factor/removal",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(400, 404, 409, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def remove_second_factor(
    context: Context, request: Request, asking: Asking, wanted: OwnPassword
) -> None:
    """Remove the own second factor; 409 where a role needs it."""
    require_session(asking)
    await check_own_password(context, request, asking, wanted.password)
    if second_factors.is_required(context.settings.access, asking.actor.roles):
        raise ProblemError(
            HTTPStatus.CONFLICT,
            "your role needs a second factor: set up another app in its place, or ask a SECADM for a reset",
        )
    await run_in_threadpool(
        partial(
            context.repository.remove_second_factor,
            asking.actor.name,
            by=asking.actor,
            now_ns=time.time_ns(),
        )
    )


@router.post(
    "/users/{name}/second-factor/reset",
    responses=problems(404, 409),
    dependencies=[require(Permission.USERS)],
)
def reset_second_factor(context: Context, name: UserName, caller: By) -> OneTimeCode:
    """Remove another user's second factor; return a code with which they log in once to set up another.

    Their sessions and tokens end.
    """
    if name == caller.name:  # whose token asks would get a session by it, which may do more
        raise ProblemError(
            HTTPStatus.CONFLICT,
            f"no second factor of user {name!r} was reset: it is your own: remove it with your password (mcc "
            f"second-factor remove), or have the owner of the service's files reset it (mcc user "
            f"reset-second-factor {name} --config FILE)",
        )
    (code,) = second_factors.new_recovery_codes(1)
    digest = second_factors.digest_of_code(code)
    context.repository.reset_second_factor(name, digest, by=caller, now_ns=time.time_ns())
    return OneTimeCode(code=code)


def _keep_codes(context: ApiContext, asking: Caller, codes: Sequence[str]) -> None:
    """Keep new codes of a user who has a second factor. Raises ProblemError (409)."""
    repository, name = context.repository, asking.actor.name
    if not repository.user(name).has_second_factor:
        raise ProblemError(HTTPStatus.CONFLICT, "you have no second factor: set one up first")
    digests = map(second_factors.digest_of_code, codes)
    repository.replace_recovery_codes(name, digests, by=asking.actor, now_ns=time.time_ns())


def require_session(asking: Caller) -> str:
    """Return the digest of the session that asks. Raises ProblemError (403): a token changes no factor."""
    if asking.session is None:
        raise ProblemError(HTTPStatus.FORBIDDEN, "log in to change your second factor; a token may not")
    return asking.session
