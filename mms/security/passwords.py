"""Passwords of MMS associations: ACSE authentication by password (ISO 8650-1 clause 8.1, IEC 61850-8-1).

It travels as it is: only TLS hides it from those who listen.
"""

import ctypes
import hmac
from collections.abc import Iterable
from typing import Final

from mms.binding.callbacks import guarded
from mms.binding.prototypes import Authenticator

_PASSWORD: Final = 1  # AcseAuthenticationMechanism
_NOBODY: Final = False
LONGEST: Final = 64
EXPECTED: Final = f"a password of 1 to {LONGEST} printable ASCII characters"


def is_password(text: str) -> bool:
    """Whether it can be sent: the standard's GraphicString, with no more than one octet of length."""
    return 0 < len(text) <= LONGEST and text.isascii() and text.isprintable()


class ClientPassword:
    """The library's AcseAuthenticationParameter, for one connection, and destroyed after it."""

    def __init__(self, lib: ctypes.CDLL, password: str) -> None:
        """ValueError, which does not show it, where it cannot be sent."""
        if not is_password(password):
            raise ValueError(f"expected {EXPECTED}, found something else")
        self._lib = lib
        self.pointer = int(lib.AcseAuthenticationParameter_create())
        lib.AcseAuthenticationParameter_setAuthMechanism(self.pointer, _PASSWORD)
        lib.AcseAuthenticationParameter_setPassword(self.pointer, password.encode("ascii"))

    def destroy(self) -> None:
        """Free it, once its connection has been destroyed; harmless twice."""
        pointer, self.pointer = self.pointer, 0
        if pointer:
            self._lib.AcseAuthenticationParameter_destroy(pointer)


def authenticator(lib: ctypes.CDLL, passwords: Iterable[str]) -> object | None:
    """For a server, the library's AcseAuthenticator: lets in who knows one of the passwords; None for none.

    ValueError where one cannot be sent.
    """
    known = tuple(passwords)
    if not known:
        return None
    if not all(map(is_password, known)):
        raise ValueError(f"expected {EXPECTED}, found something else")
    accepted = tuple(password.encode("ascii") for password in known)

    def knows(_parameter: int | None, offered: int, _token: int | None, _application: int | None) -> bool:
        if lib.AcseAuthenticationParameter_getAuthMechanism(offered) != _PASSWORD:
            return False
        length = lib.AcseAuthenticationParameter_getPasswordLength(offered)
        content = lib.AcseAuthenticationParameter_getPassword(offered)
        given = ctypes.string_at(content, length) if content and length > 0 else b""
        return any(hmac.compare_digest(given, password) for password in accepted)

    return Authenticator(guarded(knows, _NOBODY))
