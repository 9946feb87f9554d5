"""What users show besides a password, so that a stolen password alone opens nothing.

It is a code of an authenticator app (TOTP, RFC 6238), each taken once, or a recovery code. The secrets of
apps are sealed; recovery codes are kept as digests.
"""

import secrets
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final

import pyotp
from pyotp.utils import strings_equal

from core.units import NANOSECONDS_PER_SECOND
from service.access.bearer_secrets import digest_of
from service.configuration.access import AccessSettings
from service.process.sealing import Seal
from service.storage import Repository
from service.storage.records import Actor, Role, User

ISSUER: Final = "StatorWatch"
STEP_S: Final = 30
STEPS_AROUND: Final = 1
"""A clock may be so many steps fast or slow."""

DIGITS: Final = 6
LONGEST_CODE: Final = 40

CODES: Final = 10
"""Recovery codes that a user has at a time."""

LETTERS: Final = "abcdefghjkmnpqrstuvwxyz23456789"
"""Those of recovery codes: none looks like another one."""

CODE_LETTERS: Final = 16
"""Of a recovery code: nearly 80 bits, of which a digest need not be slow."""


class FactorError(Exception):
    """A second factor cannot be set up, changed or removed so; it says why."""


class WrongCodeError(FactorError):
    """The code is not that of the app which is being set up."""

    def __init__(self) -> None:
        super().__init__("expected the code that the app shows now; look at the clock of the telephone too")


@dataclass(frozen=True, slots=True)
class TotpProposal:
    """A new secret for an authenticator app, and its address, which the app reads as a picture."""

    secret: str
    uri: str


def is_required(settings: AccessSettings, roles: Collection[Role]) -> bool:
    """Tell whether one of these roles needs a second factor."""
    return any(role.value in settings.second_factor_roles for role in roles)


def is_asked_of(settings: AccessSettings, user: User) -> bool:
    """Tell whether a password of this user lets nobody in alone."""
    return user.has_second_factor or is_required(settings, user.roles)


def is_missing(settings: AccessSettings, user: User) -> bool:
    """Tell whether this user may do nothing but set up the second factor that their role needs.

    Who has no password here logs in elsewhere, where the second factor is asked for.
    """
    return user.has_password and is_required(settings, user.roles) and not user.has_second_factor


def new_recovery_codes(number: int = CODES) -> Sequence[str]:
    """Return new codes, to be shown once."""
    return [_in_groups("".join(secrets.choice(LETTERS) for _ in range(CODE_LETTERS))) for _ in range(number)]


def digest_of_code(code: str) -> str:
    """Return what is kept of a recovery code."""
    return digest_of(_bare(code))


def propose_totp(repository: Repository, seal: Seal, user: str, *, by: Actor, now_ns: int) -> TotpProposal:
    """Return a new secret for a user's app; it counts once a code confirms it. Raises NotFoundError."""
    secret = pyotp.random_base32()
    repository.propose_totp(user, seal.closed(secret, _place(user)), by=by, now_ns=now_ns)
    return TotpProposal(secret, pyotp.TOTP(secret).provisioning_uri(name=user, issuer_name=ISSUER))


def confirm_totp(
    repository: Repository, seal: Seal, user: str, code: str, *, session: str, by: Actor, now_ns: int
) -> Sequence[str]:
    """Have the proposed secret count, and return new recovery codes.

    session: the digest of the one that asks. Raises FactorError, SealError, NotFoundError.
    """
    pending = repository.totp_secrets(user).pending
    if pending is None:
        raise FactorError("no authenticator app is being set up: begin anew")
    step = step_of(seal.opened(pending, _place(user)), _bare(code), now_ns=now_ns)
    if step is None:
        raise WrongCodeError
    codes = new_recovery_codes()
    is_kept = repository.confirm_totp(
        user,
        pending,
        step,
        codes=map(digest_of_code, codes),
        keeps=session,
        by=by,
        now_ns=now_ns,
    )
    if not is_kept:
        raise FactorError("the authenticator app was set up anew meanwhile: begin anew")
    return codes


def is_passed(repository: Repository, seal: Seal, user: str, code: str, *, by: Actor, now_ns: int) -> bool:
    """Tell whether a code is one of the user's app or a recovery code, and use it up.

    Raises SealError, NotFoundError.
    """
    bare = _bare(code)
    if len(bare) != DIGITS:
        return repository.use_recovery_code(user, digest_of(bare), by=by, now_ns=now_ns)
    sealed = repository.totp_secrets(user).confirmed
    if sealed is None:
        return False
    step = step_of(seal.opened(sealed, _place(user)), bare, now_ns=now_ns)
    return step is not None and repository.use_totp_step(user, step)


def step_of(secret: str, code: str, *, now_ns: int) -> int | None:
    """Return the step of time whose code this is; None for none that is near."""
    app = pyotp.TOTP(secret, digits=DIGITS, interval=STEP_S)
    now = now_ns // (STEP_S * NANOSECONDS_PER_SECOND)
    steps = range(now - STEPS_AROUND, now + STEPS_AROUND + 1)
    fitting = [step for step in steps if strings_equal(app.generate_otp(step), code)]
    return max(fitting, default=None)


def _place(user: str) -> str:
    """Return what the secret of an app is sealed for."""
    return f"authenticator app of {user}"


def _bare(code: str) -> str:
    """Return a code without what makes it easy to read."""
    return "".join(code.lower().split()).replace("-", "")[:LONGEST_CODE]


def _in_groups(code: str) -> str:
    return "-".join(code[start : start + 4] for start in range(0, len(code), 4))
