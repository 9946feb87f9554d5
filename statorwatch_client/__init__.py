"""A typed client of StatorWatch's REST API.

`models`, the types of the documents, and `operations` are made from the service's OpenAPI document by
`make client` in its repository.
"""

from statorwatch_client.client import Client
from statorwatch_client.errors import ServiceError

__all__ = ["Client", "ServiceError"]
