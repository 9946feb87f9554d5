"""A lower limit on the throughput of a download."""

from mms import errors
from mms.client.limits import ClientLimits


class ThroughputLimit:
    """Ends a download that brings too few bytes a second, though each of its parts comes in time.

    The throughput is averaged over successive windows. Only the time of the requests counts, because a slow
    disk on the client's side is not the relay's fault.

    Parameters
    ----------
    host : str
        The relay as "address:port", for the message.
    operation : str
        The service and its object, for the message.
    limits : ClientLimits
        The least throughput and the length of a window.
    """

    def __init__(self, host: str, operation: str, limits: ClientLimits) -> None:
        self._host = host
        self._operation = operation
        self._limits = limits
        self._bytes = 0
        self._seconds = 0.0

    def add(self, number_of_bytes: int, seconds: float) -> None:
        """Count what one request brought.

        Parameters
        ----------
        number_of_bytes : int
            Bytes received.
        seconds : float
            Time from the request to its answer [s].

        Raises
        ------
        Timeout
            A whole window brought less than the least throughput.
        """
        self._bytes += number_of_bytes
        self._seconds += seconds
        if self._seconds < self._limits.throughput_window_s:
            return
        if self._bytes < self._limits.bytes_per_s * self._seconds:
            reason = (
                f"expected at least {self._limits.bytes_per_s:g} bytes a second, "
                f"received {self._bytes} bytes in {self._seconds:.1f} s"
            )
            raise errors.Timeout(self._host, self._operation, 0, reason)
        self._bytes, self._seconds = 0, 0.0
