"""Explanation of a failed connect: the library tells only that it failed.

After a failure, and only then, one or two connections of our own look at what answers there. They send what
any client begins with: a transport connect request (ISO 8073, in TPKT) or a TLS ClientHello. They send no
password. They show our certificate only to a relay that the library trusts and that has not said whether it
accepts the certificate.
"""

import socket
import ssl
import time
from enum import Enum
from typing import Final

from mms import errors
from mms.security.tls import TLS_PORT, TlsContext, TlsVersion, unverified_context

_CONNECT_REQUEST: Final = bytes.fromhex("0300001611e00000000100c0010dc2020001c1020000")
_TPKT, _TLS_ALERT, _TLS_HANDSHAKE = 3, 21, 22
_LONGEST_PROBE_S: Final = 1.0


class _Answer(Enum):
    """What a first message brought."""

    MMS = "the transport of MMS"
    TLS = "a TLS handshake"
    ALERT = "a TLS alert"
    OTHER = "something else"
    END = "the connection's end"
    NONE = "nothing"
    REFUSED = "a refusal"
    UNREACHABLE = "no connection"


def explain_failure(
    host: str, address: tuple[str, int], tls: TlsContext | None, *, password: bool, deadline: float
) -> errors.MmsError:
    """Find out why a connect failed.

    Parameters
    ----------
    host : str
        The relay as the user named it, "host:port".
    address : tuple of str and int
        IPv4 address and port that were tried.
    tls : TlsContext or None
        What the library noticed of the TLS handshake; None without TLS.
    password : bool
        Whether a password was sent.
    deadline : float
        End of the time for the connect [s, monotonic].

    Returns
    -------
    MmsError
        The kind of ConnectFailed that says why, in words for the user.
    """
    probe = _Probe(address, deadline)
    fault = None if tls is None else tls.certificate_fault()
    if tls is not None and fault is not None:
        reason = (
            f"the relay's certificate is not trusted: {fault}. Expected {', '.join(tls.trusted)}. If the "
            "relay has a new certificate, pin that one; else somebody else answers there"
        )
        return errors.RelayNotTrusted(host, "connect", 0, reason)
    if probe.is_over:
        return _no_relay(host, _Answer.NONE)
    if tls is None:
        return _without_tls(host, probe, password=password)
    version = tls.established_version
    if version is TlsVersion.TLS_1_2 or (version is TlsVersion.TLS_1_3 and probe.is_accepted(tls)):
        return errors.AssociationRejected(host, "connect", 0, _rejected(password=password))
    return _with_tls(host, probe, tls.version)


def _without_tls(host: str, probe: "_Probe", *, password: bool) -> errors.MmsError:
    answer = probe.send(_CONNECT_REQUEST)
    if answer is _Answer.MMS:
        return errors.AssociationRejected(host, "connect", 0, _rejected(password=password))
    if answer is _Answer.END:
        answer = probe.send(_client_hello(TlsVersion.TLS_1_2))
    if answer in (_Answer.TLS, _Answer.ALERT):
        reason = "the relay speaks TLS at this port: configure certificates for it (tls)"
        return errors.TlsRequired(host, "connect", 0, reason)
    return _no_relay(host, answer)


def _with_tls(host: str, probe: "_Probe", version: TlsVersion) -> errors.MmsError:
    answer = probe.send(_client_hello(version))
    if answer is _Answer.TLS:
        reason = (
            "the relay ended the TLS handshake: it does not take our certificate. Expected: one that the "
            "relay has pinned or whose authority it knows, and which is valid by the relay's clock"
        )
        return errors.CertificateRefused(host, "connect", 0, reason)
    if answer is _Answer.ALERT:
        return errors.ConnectFailed(host, "connect", 0, _nothing_in_common(probe, version))
    if answer is _Answer.END and probe.send(_CONNECT_REQUEST) is _Answer.MMS:
        reason = (
            "the relay answers at this port without TLS: expected TLS. Turn it on in the relay, or give its "
            f"TLS port (usually {TLS_PORT}), or take tls out of the relay's configuration"
        )
        return errors.TlsNotSpoken(host, "connect", 0, reason)
    return _no_relay(host, answer)


def _nothing_in_common(probe: "_Probe", version: TlsVersion) -> str:
    """Return why a relay answers our ClientHello with an alert."""
    other = next(one for one in TlsVersion if one is not version)
    if probe.send(_client_hello(other)) is _Answer.TLS:
        return f'the relay speaks TLS {other}, not {version}: set version = "{other}" in its table tls'
    return (
        f"the relay speaks TLS, but not TLS {version} with a cipher suite that we offer: ECDHE or DHE, with "
        "AES-GCM (forward secrecy). Is its firmware old?"
    )


def _rejected(*, password: bool) -> str:
    if password:
        return "the relay rejects the association: expected the password it knows, found another one"
    return "the relay rejects the association: does it want a password? None is configured for it"


def _no_relay(host: str, answer: _Answer) -> errors.MmsError:
    reasons = {
        _Answer.REFUSED: "the connection was rejected: nothing listens at this port",
        _Answer.UNREACHABLE: "no connection: is the relay on, its address right, the way to it open?",
        _Answer.NONE: "no answer in time",
        _Answer.END: "the relay ends every connection at once: no session left?",
    }
    default = "what answers there speaks neither MMS nor TLS: is the port right?"
    return errors.ConnectFailed(host, "connect", 0, reasons.get(answer, default))


class _Probe:
    """Sends first messages to one address and tells what kind of answer comes back."""

    def __init__(self, address: tuple[str, int], deadline: float) -> None:
        self._address = address
        self._deadline = deadline

    @property
    def is_over(self) -> bool:
        return time.monotonic() >= self._deadline

    @property
    def _timeout_s(self) -> float:
        return min(_LONGEST_PROBE_S, self._deadline - time.monotonic())

    def is_accepted(self, tls: TlsContext) -> bool:
        """Whether a relay with a pinned certificate accepts ours."""
        timeout_s = self._timeout_s
        if timeout_s <= 0:
            return False
        try:
            with (
                socket.create_connection(self._address, timeout_s) as connection,
                tls.ssl_context().wrap_socket(connection) as secured,
            ):
                if not tls.is_pinned(secured.getpeercert(binary_form=True)):
                    return False
                secured.sendall(_CONNECT_REQUEST)
                return secured.recv(1)[:1] == bytes([_TPKT])
        except OSError:
            return False

    def send(self, message: bytes) -> _Answer:
        """Return the kind of the answer to a message; NONE too where no time is left to ask."""
        timeout_s = self._timeout_s
        if timeout_s <= 0:
            return _Answer.NONE
        try:
            connection = socket.create_connection(self._address, timeout_s)
        except ConnectionRefusedError:
            return _Answer.REFUSED
        except OSError:
            return _Answer.UNREACHABLE
        with connection:
            try:
                connection.sendall(message)
                first = connection.recv(1)
            except TimeoutError:
                return _Answer.NONE
            except OSError:
                return _Answer.END
        kinds = {_TPKT: _Answer.MMS, _TLS_ALERT: _Answer.ALERT, _TLS_HANDSHAKE: _Answer.TLS}
        return kinds.get(first[0], _Answer.OTHER) if first else _Answer.END


def _client_hello(version: TlsVersion) -> bytes:
    context = unverified_context(version)  # the handshake ends before any certificate comes
    outgoing = ssl.MemoryBIO()
    handshake = context.wrap_bio(ssl.MemoryBIO(), outgoing)
    try:
        handshake.do_handshake()
    except ssl.SSLWantReadError:
        return outgoing.read()
    raise AssertionError("a handshake with nobody")
