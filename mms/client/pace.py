"""An end for a transfer of which every part comes in time, and hardly anything with it."""

from typing import Final

from mms import errors

LEAST_BYTES_PER_S: Final = 100.0
"""A serial line of 9600 baud carries 960 octets a second: a tenth is left to one that is shared or noisy."""

WINDOW_S: Final = 30.0
"""Of waiting for the relay: several requests, so that a pause at the relay or on the way ends nothing."""


class Pace:
    """How much of a file comes a second, looked at over successive windows of WINDOW_S.

    Only the time of the requests counts: a slow disk on our side is not the relay's doing.
    """

    def __init__(self, host: str, operation: str) -> None:
        self._host = host
        self._operation = operation
        self._bytes = 0
        self._seconds = 0.0

    def note(self, number_of_bytes: int, seconds: float) -> None:
        """One request brought so many bytes in so many seconds.

        Raises Timeout where a whole window brought fewer than LEAST_BYTES_PER_S.
        """
        self._bytes += number_of_bytes
        self._seconds += seconds
        if self._seconds < WINDOW_S:
            return
        if self._bytes < LEAST_BYTES_PER_S * self._seconds:
            reason = (
                f"expected at least {LEAST_BYTES_PER_S:g} bytes a second, "
                f"received {self._bytes} bytes in {self._seconds:.1f} s"
            )
            raise errors.Timeout(self._host, self._operation, 0, reason)
        self._bytes, self._seconds = 0, 0.0
