"""Passwords of MMS associations: ACSE authentication by password (ISO 8650-1 clause 8.1, IEC 61850-8-1).

A password is sent in clear: only TLS hides it from those who listen.
"""

import ctypes
import hmac
from collections.abc import Iterable
from typing import Final

from mms.binding.callbacks import guarded
from mms.binding.prototypes import Authenticator

_PASSWORD: Final = 1  # AcseAuthenticationMechanism
_NOBODY: Final = False
LONGEST_PASSWORD: Final = 64
PASSWORD_RULE: Final = f"a password of 1 to {LONGEST_PASSWORD} printable ASCII characters"


def is_password(text: str) -> bool:
    """Tell whether a password can be sent.

    The standard's GraphicString is limited to a length that one octet can tell.

    Parameters
    ----------
    text : str
        The password.

    Returns
    -------
    bool
        True for 1 to 64 printable ASCII characters.
    """
    return 0 < len(text) <= LONGEST_PASSWORD and text.isascii() and text.isprintable()


class ClientPassword:
    """Password of one client connection in the library, destroyed after the connection.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    password : str
        The password.

    Raises
    ------
    ValueError
        The password cannot be sent; the message does not show it.
    """

    def __init__(self, lib: ctypes.CDLL, password: str) -> None:
        if not is_password(password):
            raise ValueError(f"expected {PASSWORD_RULE}, found something else")
        self._lib = lib
        self.pointer = int(lib.AcseAuthenticationParameter_create())
        lib.AcseAuthenticationParameter_setAuthMechanism(self.pointer, _PASSWORD)
        lib.AcseAuthenticationParameter_setPassword(self.pointer, password.encode("ascii"))

    def destroy(self) -> None:
        """Free the library's object once its connection has been destroyed; a second call does nothing."""
        pointer, self.pointer = self.pointer, 0
        if pointer:
            self._lib.AcseAuthenticationParameter_destroy(pointer)


def make_authenticator(lib: ctypes.CDLL, passwords: Iterable[str]) -> object | None:
    """Make the library's callback that lets in clients with one of the passwords.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    passwords : iterable of str
        Accepted passwords.

    Returns
    -------
    object or None
        The ctypes callback (AcseAuthenticator); None where there are no passwords.

    Raises
    ------
    ValueError
        A password cannot be sent.
    """
    known = tuple(passwords)
    if not known:
        return None
    if not all(map(is_password, known)):
        raise ValueError(f"expected {PASSWORD_RULE}, found something else")
    accepted = tuple(password.encode("ascii") for password in known)

    def knows(_parameter: int | None, offered: int, _token: int | None, _application: int | None) -> bool:
        if lib.AcseAuthenticationParameter_getAuthMechanism(offered) != _PASSWORD:
            return False
        length = lib.AcseAuthenticationParameter_getPasswordLength(offered)
        content = lib.AcseAuthenticationParameter_getPassword(offered)
        given = ctypes.string_at(content, length) if content and length > 0 else b""
        return any(hmac.compare_digest(given, password) for password in accepted)

    return Authenticator(guarded(knows, _NOBODY))
