"""Errors of GOOSE: a frame that is none, a socket that cannot be had."""


class GooseError(Exception):
    """Something about GOOSE failed; the message says what, where and what to do."""


class GooseFrameError(GooseError):
    """Octets are no GOOSE frame as IEC 61850-8-1 describes it.

    Parameters
    ----------
    place : str
        The field, such as "stNum".
    expected : str
        What was expected there.
    found : str
        What was found.
    """

    def __init__(self, place: str, expected: str, found: str) -> None:
        super().__init__(place, expected, found)
        self.place = place
        self.expected = expected
        self.found = found

    def __str__(self) -> str:
        return f"{self.place}: expected {self.expected}, found {self.found}"


class RawSocketError(GooseError):
    """No raw socket can be had on an interface.

    Parameters
    ----------
    interface : str
        Name of the network interface.
    reason : str
        Why not, and what to do.
    """

    def __init__(self, interface: str, reason: str) -> None:
        super().__init__(interface, reason)
        self.interface = interface
        self.reason = reason

    def __str__(self) -> str:
        return f"{self.interface}: {self.reason}"
