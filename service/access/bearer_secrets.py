"""Secrets of sessions and tokens: made at random, kept as digests only.

They have 256 random bits. A digest of such a secret need not be slow, as that of a password.
"""

import hashlib
import secrets
from typing import Final

TOKEN_PREFIX: Final = "mcc_"  # noqa: S105 - what tokens begin with, so that programs that look for secrets find them
LONGEST: Final = 200


def new_token() -> str:
    """Return a secret for a program."""
    return f"{TOKEN_PREFIX}{secrets.token_urlsafe(32)}"


def new_session() -> str:
    """Return a secret for a login."""
    return secrets.token_urlsafe(32)


def digest_of(secret: str) -> str:
    """Return what is kept of a secret."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()
