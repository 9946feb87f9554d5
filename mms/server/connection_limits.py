"""How long a client of one server may take to begin, which the MMS library leaves open."""

from contextlib import AbstractContextManager, nullcontext

from mms.server.handshake_limit import end_connections_after
from mms.server.silent_connections import SilentConnections


class ConnectionLimits:
    """Limits of time for the connections to one of our ports.

    Parameters
    ----------
    own : tuple of str and int
        Address and port at this end.
    handshake_s : float, optional
        Longest TLS handshake [s].
    association_s : float, optional
        Time after which a client that has not associated is sent away [s].
    """

    def __init__(
        self, own: tuple[str, int], *, handshake_s: float | None, association_s: float | None
    ) -> None:
        self._own = own
        self._handshake_s = handshake_s
        self._silent = None if association_s is None else SilentConnections(own, association_s)

    def start(self) -> None:
        """Begin to look after connections."""
        if self._silent is not None:
            self._silent.start()

    def stop(self) -> None:
        """Leave connections alone."""
        if self._silent is not None:
            self._silent.stop()

    def accepting(self) -> AbstractContextManager[None]:
        """Limit the handshakes of connections that are accepted within a block.

        Returns
        -------
        context manager
            The block.
        """
        return (
            nullcontext()
            if self._handshake_s is None
            else end_connections_after(self._own, self._handshake_s)
        )
