"""The REST API under /api/v1 and the probes of an operator (health, readiness, metrics)."""

from service.api.app import create_app
from service.api.context import ApiContext

__all__ = ["ApiContext", "create_app"]
