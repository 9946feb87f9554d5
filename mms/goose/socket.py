"""A raw socket on one network interface, for GOOSE frames alone (Linux, AF_PACKET; needs CAP_NET_RAW)."""

import socket
import struct
from collections.abc import Iterable
from types import TracebackType
from typing import Self

from mms.goose.errors import RawSocketError
from mms.goose.frame import ETHERTYPE

LONGEST_FRAME = 2048
"""Octets: Ethernet's longest frame has 1518, with a tag. A longer one is cut, and then refused."""
BUFFER_BYTES = 1024 * 1024
"""Room for what comes while nobody reads."""

_SOL_PACKET = 263
_ADD_MEMBERSHIP = 1
_MULTICAST = 0


class RawSocket:
    """Sends and receives GOOSE frames on one interface. A context manager that closes the socket.

    Parameters
    ----------
    interface : str
        Name of the network interface.
    groups : iterable of bytes
        Multicast addresses to be received, six octets each; none for a socket that only sends.

    Raises
    ------
    RawSocketError
        The interface does not exist, or the capability CAP_NET_RAW is missing.
    """

    def __init__(self, interface: str, groups: Iterable[bytes] = ()) -> None:
        self.interface = interface
        try:
            index = socket.if_nametoindex(interface)
        except OSError:
            names = ", ".join(name for _, name in socket.if_nameindex())
            raise RawSocketError(
                interface, f"expected a network interface of this machine, one of {names}"
            ) from None
        try:
            # Bound before it hears anything: with protocol 0 a socket receives nothing.
            self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, 0)
        except PermissionError:
            raise RawSocketError(
                interface, "a raw socket needs the capability CAP_NET_RAW, which this process does not have"
            ) from None
        try:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
            for group in sorted(set(groups)):
                membership = struct.pack("iHH8s", index, _MULTICAST, len(group), group)
                self._socket.setsockopt(_SOL_PACKET, _ADD_MEMBERSHIP, membership)
            self._socket.bind((interface, ETHERTYPE))
        except OSError as error:
            self._socket.close()
            raise RawSocketError(interface, f"no raw socket can be had: {error}") from error

    def send(self, frame: bytes) -> None:
        """Send a frame.

        Parameters
        ----------
        frame : bytes
            The frame with its Ethernet header.

        Raises
        ------
        OSError
            The interface is down or gone.
        """
        self._socket.send(frame)

    def receive(self) -> bytes:
        """Wait for a frame.

        Returns
        -------
        bytes
            The frame. A tag of a virtual LAN is gone: Linux takes it away, and tells it only to sockets of
            all Ethertypes (PACKET_AUXDATA). Where it leaves one, `decode_frame` reads it.

        Raises
        ------
        OSError
            The interface is down or gone.
        TimeoutError
            None came within the time of `wait_at_most`.
        """
        return self._socket.recv(LONGEST_FRAME)

    def wait_at_most(self, timeout_s: float | None) -> None:
        """Limit the time that `receive` waits.

        Parameters
        ----------
        timeout_s : float or None
            The time [s]; None for no limit.
        """
        self._socket.settimeout(timeout_s)

    @property
    def address(self) -> bytes:
        """Ethernet address of the interface, six octets."""
        found: bytes = self._socket.getsockname()[4]
        return found

    def fileno(self) -> int:
        """Return the file descriptor, for `select`.

        Returns
        -------
        int
            The descriptor.
        """
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
