"""What a client shows a relay: its certificate, its password, both or neither."""

import ctypes

from mms.security.passwords import ClientPassword
from mms.security.tls import TlsConfiguration, TlsContext


class Credentials:
    """TLS configuration and password of one client in the library.

    They are destroyed after the client's connection.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    tls : TlsConfiguration or None
        Our certificate and those we trust.
    password : str or None
        Password of ACSE.

    Raises
    ------
    CredentialFileError
        A file of `tls` cannot be used.
    ValueError
        The password cannot be sent.
    """

    def __init__(self, lib: ctypes.CDLL, tls: TlsConfiguration | None, password: str | None) -> None:
        self._lib = lib
        self._password = None if password is None else ClientPassword(lib, password)
        try:
            self.tls = None if tls is None else TlsContext(lib, tls)
        except BaseException:
            self._destroy_password()
            raise

    @property
    def has_password(self) -> bool:
        """Whether a password is sent."""
        return self._password is not None

    def new_connection(self) -> int:
        """Make a connection of the library that will show the credentials.

        With TLS it has a thread of the library's own: what TLS has decrypted already is no event of a socket.

        Returns
        -------
        int
            Pointer to the IedConnection. The caller destroys it.

        Raises
        ------
        MemoryError
            The library has no memory for it.
        """
        lib = self._lib
        if self.tls is not None:
            self.tls.reset()
        tls = None if self.tls is None else self.tls.pointer
        pointer = int(lib.IedConnection_createEx(tls, tls is not None) or 0)
        if not pointer:
            raise MemoryError("the MMS library has no memory for a connection")
        if self._password is not None:
            parameters = lib.MmsConnection_getIsoConnectionParameters(
                lib.IedConnection_getMmsConnection(pointer)
            )
            lib.IsoConnectionParameters_setAcseAuthenticationParameter(parameters, self._password.pointer)
        return pointer

    def destroy(self) -> None:
        """Free the library's objects once none of their connections is left; a second call does nothing."""
        if self.tls is not None:
            self.tls.destroy()
        self._destroy_password()

    def _destroy_password(self) -> None:
        if self._password is not None:
            self._password.destroy()
