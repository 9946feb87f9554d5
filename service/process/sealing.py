"""Secrets that the database keeps sealed: whoever has it, or a back-up of it, but not the key, reads none.

The key is a file outside the database. What is sealed for one place is opened for no other one, so that
whoever may write to the database cannot give one user the secret of another.
"""

import os
import uuid
from base64 import urlsafe_b64decode, urlsafe_b64encode
from contextlib import suppress
from pathlib import Path
from typing import Final

from cryptography.exceptions import InvalidTag
from cryptography.hazmat.primitives.ciphers.aead import AESGCM

from mms import CredentialFileError, read_secret

KEY_BITS: Final = 256
NONCE_BYTES: Final = 12
VERSION: Final = "1."
"""What everything sealed begins with."""


class SealError(Exception):
    """The key cannot be used, or does not open what was sealed; it says which file, and what to do."""


class Seal:
    """Closes and opens secrets with the key of a file (AES-256-GCM)."""

    def __init__(self, path: Path) -> None:
        """Read the key; make the file, its owner's alone, where there is none. Raises SealError."""
        self._path = path
        try:
            if not path.exists():
                _make(path)
            key = urlsafe_b64decode(read_secret(path).strip())
            self._cipher = AESGCM(key)
        except (OSError, CredentialFileError) as error:
            raise SealError(f"secrets_key_file: {error}") from error
        except ValueError as error:
            raise SealError(
                f"secrets_key_file: {path}: expected {KEY_BITS} bits in base64, as the service made them: "
                "put the file back from where it is kept"
            ) from error

    def closed(self, secret: str, place: str) -> str:
        """Return a secret as it may be kept. place: whose it is, and what for; it opens there alone."""
        nonce = os.urandom(NONCE_BYTES)
        content = nonce + self._cipher.encrypt(nonce, secret.encode(), place.encode())
        return VERSION + urlsafe_b64encode(content).decode()

    def opened(self, sealed: str, place: str) -> str:
        """Return the secret that was closed for a place. Raises SealError."""
        try:
            content = urlsafe_b64decode(sealed.removeprefix(VERSION))
            nonce, closed = content[:NONCE_BYTES], content[NONCE_BYTES:]
            return self._cipher.decrypt(nonce, closed, place.encode()).decode()
        except (InvalidTag, ValueError) as error:
            raise SealError(
                f"{place}: the key of {self._path} (secrets_key_file) does not open what the database keeps: "
                "put the key back that it was sealed with, or set the secret anew"
            ) from error


def _make(path: Path) -> None:
    """Write a new key, complete at once; of two processes the first one wins. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    made = path.with_name(f"{path.name}.{uuid.uuid4().hex}")
    descriptor = os.open(made, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(urlsafe_b64encode(AESGCM.generate_key(KEY_BITS)) + b"\n")
            file.flush()
            os.fsync(file.fileno())
        with suppress(FileExistsError):
            path.hardlink_to(made)
    finally:
        made.unlink(missing_ok=True)
