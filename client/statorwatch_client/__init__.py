"""A typed client of the REST API of StatorWatch."""

from typing import TYPE_CHECKING

from statorwatch_client.client import Client, Download
from statorwatch_client.errors import ProblemError, ServiceError

if TYPE_CHECKING:
    from statorwatch_client.async_client import AsyncClient, AsyncDownload

__all__ = ["AsyncClient", "AsyncDownload", "Client", "Download", "ProblemError", "ServiceError"]


def __getattr__(name: str) -> object:
    """Return what is for asyncio. It is read when somebody uses it: commands of one request begin sooner."""
    if name in ("AsyncClient", "AsyncDownload"):
        from statorwatch_client import async_client

        found: object = getattr(async_client, name)
        return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
