"""Passwords: which are taken, and their hashes (Argon2id, RFC 9106)."""

import re
from typing import Final

from pwdlib.hashers.argon2 import Argon2Hasher
from zxcvbn import zxcvbn

LEAST_CHARACTERS: Final = 10
MOST_BYTES: Final = 1024

PASSWORD_RULE: Final = (
    f"a password of at least {LEAST_CHARACTERS} characters (at most {MOST_BYTES} bytes) that is hard to "
    "guess (no common words alone, no names of the user) and not the present one"
)

LEAST_SCORE: Final = 3
"""Of zxcvbn's 0 to 4: whoever has the hashes needs 10^8 guesses or more."""

JUDGED_CHARACTERS: Final = 72
"""So many from the first on are judged, which bounds the time that it takes to a tenth of a second."""

HASH_MEMORY_KIB: Final = 64 * 1024
"""What one hash needs of memory; the API bounds how many are made at once."""

_HASHER: Final = Argon2Hasher(time_cost=3, memory_cost=HASH_MEMORY_KIB, parallelism=1)

_NOBODYS: Final = (
    "$argon2id$v=19$m=65536,t=3,p=1$c3RhdG9yd2F0Y2gtbm9ib2R5$Nfy3nFqsPFkMAcVCyvzmOsGXhYJ1cWVmVn2ofIRrE7A"
)
"""Looked at in place of the hash of a user who is not there, so that both cost the same time."""


class UnusablePasswordError(ValueError):
    """A new password does not fit the rule; the message says why, without the password."""

    def __init__(self, found: str) -> None:
        super().__init__(f"expected {PASSWORD_RULE}; found {found}")


def new_hash(password: str, name: str, *, full_name: str | None = None, present: str | None = None) -> str:
    """Return a hash of a password that somebody chooses for a user. Raises UnusablePasswordError.

    present: the hash of the password that they have. It takes as long, and the memory, of two hashes.
    """
    _require_size(password)
    _require_hard_to_guess(password, name, full_name or "")
    if present is not None and is_correct(password, present):
        raise UnusablePasswordError("the present one")
    return hashed(password)


def _require_size(password: str) -> None:
    try:
        size = len(password.encode("utf-8"))
    except UnicodeEncodeError as error:
        raise UnusablePasswordError("half of a character") from error
    if len(password) < LEAST_CHARACTERS:
        raise UnusablePasswordError(f"{len(password)} characters")
    if size > MOST_BYTES:
        raise UnusablePasswordError(f"{size} bytes")
    if "\0" in password:
        raise UnusablePasswordError("a null character")


def _require_hard_to_guess(password: str, name: str, full_name: str) -> None:
    known = [name, *re.split(r"[\W_]+", name), full_name, *full_name.split(), "statorwatch"]
    judged = zxcvbn(password[:JUDGED_CHARACTERS], user_inputs=[word for word in known if word])
    if judged["score"] < LEAST_SCORE:
        why = judged["feedback"]["warning"]
        raise UnusablePasswordError(f"one that is easy to guess. {why}".rstrip(". "))


def hashed(password: str) -> str:
    """Return a hash to be kept."""
    return _HASHER.hash(password)


def is_correct(password: str, kept: str | None) -> bool:
    """Tell whether a password is that of a kept hash. None for no such user, which takes as long."""
    try:
        given = password.encode("utf-8")[: MOST_BYTES + 1]
    except UnicodeEncodeError:
        given = b""
    return _HASHER.verify(given, _NOBODYS if kept is None else kept) and kept is not None


def needs_renewal(kept: str) -> bool:
    """Tell whether a hash was made with other costs than those of today."""
    return _HASHER.check_needs_rehash(kept)
