"""The client of one service: every operation of its API as a method, with types."""

import ssl
from collections.abc import Mapping
from types import TracebackType
from typing import Self

from statorwatch_client.operations import Operations
from statorwatch_client.transport import TIMEOUT_S, Transport


class Client(Operations):
    """Ask one service. A context manager that closes the connections.

    Parameters
    ----------
    url : str
        Address of the service, "https://motors.example:8710".
    token : str or None
        A token of the service (`mcc token add` makes one); None says nothing of who asks.
    verify : ssl.SSLContext or None
        Whom TLS trusts; None for the authorities of the system. For a plant's own authority:
        `ssl.create_default_context(cafile="plant-ca.pem")`.
    timeout_s : float
        An answer that takes longer is given up [s].
    headers : mapping of str to str
        Further headers.

    Raises
    ------
    ServiceError
        The address is none.

    Examples
    --------
    >>> with Client("http://127.0.0.1:8710", token=token) as plant:
    ...     for motor in plant.iter_motors(health=True):
    ...         print(motor["name"], motor["health"])
    """

    def __init__(
        self,
        url: str,
        *,
        token: str | None = None,
        verify: ssl.SSLContext | None = None,
        timeout_s: float = TIMEOUT_S,
        headers: Mapping[str, str] | None = None,
    ) -> None:
        who = {} if token is None else {"Authorization": f"Bearer {token}"}
        super().__init__(
            Transport(url, headers={**(headers or {}), **who}, verify=verify, timeout_s=timeout_s)
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.transport.close()
