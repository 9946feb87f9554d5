"""A typed client of StatorWatch's REST API.

`models` and `operations` are made from the service's OpenAPI document: `make client` in its repository.
"""

from statorwatch_client import models
from statorwatch_client.client import Client
from statorwatch_client.errors import ServiceError

__all__ = ["Client", "ServiceError", "models"]
