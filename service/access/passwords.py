"""Passwords: which are taken, and their hashes (Argon2id, RFC 9106)."""

from typing import Final

from pwdlib.hashers.argon2 import Argon2Hasher

LEAST_CHARACTERS: Final = 10
MOST_BYTES: Final = 1024

PASSWORD_RULE: Final = (
    f"a password of at least {LEAST_CHARACTERS} characters (at most {MOST_BYTES} bytes) that is not the "
    "user's name"
)

HASH_MEMORY_KIB: Final = 64 * 1024
"""What one hash needs of memory; the API bounds how many are made at once."""

_HASHER: Final = Argon2Hasher(time_cost=3, memory_cost=HASH_MEMORY_KIB, parallelism=1)

_NOBODYS: Final = (
    "$argon2id$v=19$m=65536,t=3,p=1$c3RhdG9yd2F0Y2gtbm9ib2R5$Nfy3nFqsPFkMAcVCyvzmOsGXhYJ1cWVmVn2ofIRrE7A"
)
"""Looked at in place of the hash of a user who is not there, so that both cost the same time."""


def is_usable(password: str, name: str) -> bool:
    """Tell whether a password fits the rule, for the user of this name."""
    try:
        size = len(password.encode("utf-8"))
    except UnicodeEncodeError:
        return False
    fits = len(password) >= LEAST_CHARACTERS and size <= MOST_BYTES and "\0" not in password
    return fits and password.casefold() != name.casefold()


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
