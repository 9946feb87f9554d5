"""What a client shows a relay: its certificate, its password, both or neither."""

import ctypes

from mms.security.passwords import ClientPassword
from mms.security.tls import TlsConfiguration, TlsContext


class Credentials:
    """The library's objects of one connection's TLS and password; destroyed after the connection."""

    def __init__(self, lib: ctypes.CDLL, tls: TlsConfiguration | None, password: str | None) -> None:
        """Raises CredentialFileError, and ValueError for a password that cannot be sent."""
        self._lib = lib
        self._password = None if password is None else ClientPassword(lib, password)
        try:
            self.tls = None if tls is None else TlsContext(lib, tls)
        except BaseException:
            self._destroy_password()
            raise

    @property
    def has_password(self) -> bool:
        return self._password is not None

    def new_connection(self) -> int:
        """The library's IedConnection that will show them; whoever asked for it destroys it."""
        lib = self._lib
        if self.tls is not None:
            self.tls.forget()
        threaded = True
        pointer = int(
            lib.IedConnection_createEx(None if self.tls is None else self.tls.pointer, threaded) or 0
        )
        if not pointer:
            raise MemoryError("the MMS library has no memory for a connection")
        if self._password is not None:
            parameters = lib.MmsConnection_getIsoConnectionParameters(
                lib.IedConnection_getMmsConnection(pointer)
            )
            lib.IsoConnectionParameters_setAcseAuthenticationParameter(parameters, self._password.pointer)
        return pointer

    def destroy(self) -> None:
        """Once no connection of theirs is left; harmless twice."""
        if self.tls is not None:
            self.tls.destroy()
        self._destroy_password()

    def _destroy_password(self) -> None:
        if self._password is not None:
            self._password.destroy()
