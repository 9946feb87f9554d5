"""Passkeys: what browsers ask devices for, and the own ones, which their user adds and removes."""

import time
from functools import partial
from http import HTTPStatus
from uuid import UUID

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool

from service.access import logins, passkeys
from service.access.passkeys import NoPasskeysError, PasskeyPlace, PasskeyRefusedError
from service.access.permissions import Permission
from service.access.second_factors import is_required
from service.api.access.callers import Asking, By
from service.api.access.requirements import open_to_all, require
from service.api.access.schemas import (
    AnyName,
    NewPasskey,
    OwnPassword,
    Passkey,
    PasskeyAnswer,
    PasskeyOptions,
    Passkeys,
)
from service.api.access.second_factor import require_session
from service.api.access.sessions import check_own_password, seal_of
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, WrongFieldError, problems

router = APIRouter(tags=["access"])


@router.get("/login/passkey", responses=problems(409), dependencies=[open_to_all()])
def ask_for_passkey(context: Context, response: Response, name: AnyName) -> PasskeyOptions:
    """Return what a browser asks a device with to log in; it does not tell whether there is such a user."""
    place, account = place_of(context), logins.account_of(name)
    options = passkeys.login_options(seal_of(context), place, account, now_ns=time.time_ns())
    response.headers["Cache-Control"] = "no-store"
    return PasskeyOptions(options=options)


@router.get("/account/passkeys", responses=problems(), dependencies=[require(Permission.ACCOUNT)])
def list_passkeys(context: Context, caller: By) -> Passkeys:
    """Return the own passkeys, the oldest first."""
    found = context.repository.passkeys(caller.name)
    return Passkeys(items=[Passkey.model_validate(one) for one in found])


@router.post(
    "/account/passkeys/options",
    responses=problems(400, 404, 409, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def propose_passkey(
    context: Context, request: Request, asking: Asking, wanted: OwnPassword
) -> PasskeyOptions:
    """Return what a browser asks a device for a new passkey with."""
    session, place = require_session(asking), place_of(context)
    await check_own_password(context, request, asking, wanted.password)
    options = await run_in_threadpool(
        lambda: passkeys.registration_options(
            context.repository, seal_of(context), place, session, by=asking.actor, now_ns=time.time_ns()
        )
    )
    return PasskeyOptions(options=options)


@router.post(
    "/account/passkeys",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.ACCOUNT)],
)
def add_passkey(context: Context, asking: Asking, wanted: PasskeyAnswer) -> NewPasskey:
    """Keep what a device has made; other own sessions end.

    Who had no second factor gets recovery codes, which are shown this once.
    """
    session = require_session(asking)
    try:
        kept, codes = passkeys.add_passkey(
            context.repository,
            seal_of(context),
            place_of(context),
            asking.actor.name,
            wanted.label,
            wanted.answer,
            session=session,
            by=asking.actor,
            now_ns=time.time_ns(),
        )
    except PasskeyRefusedError as error:
        raise WrongFieldError("body.answer", str(error)) from error
    document = Passkey.model_validate(kept).model_dump()
    return NewPasskey(**document, recovery_codes=list(codes))


@router.post(
    "/account/passkeys/{passkey_id}/removal",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(400, 404, 409, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def remove_passkey(
    context: Context, request: Request, asking: Asking, passkey_id: UUID, wanted: OwnPassword
) -> None:
    """Remove an own passkey; other own sessions end. 409 for the last factor where a role needs one."""
    session = require_session(asking)
    await check_own_password(context, request, asking, wanted.password)
    await run_in_threadpool(
        partial(
            context.repository.remove_passkey,
            asking.actor.name,
            str(passkey_id),
            needs_factor=is_required(context.settings.access, asking.actor.roles),
            keeps=session,
            by=asking.actor,
            now_ns=time.time_ns(),
        )
    )


def place_of(context: ApiContext) -> PasskeyPlace:
    """Return where passkeys count. Raises ProblemError (409) where browsers cannot use any."""
    try:
        return PasskeyPlace.of(context.settings.notifications.address)
    except NoPasskeysError as error:
        raise ProblemError(HTTPStatus.CONFLICT, str(error)) from error
