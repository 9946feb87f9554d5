"""The primary host application: an edge node that has one is born only while it is online (STATE)."""

import asyncio

import structlog
from pydantic import BaseModel, ConfigDict, Field, StrictBool, ValidationError

log = structlog.get_logger(__name__)


class HostState(BaseModel):
    """What a host says of itself.  timestamp: of its connection to the broker [ms, UTC]."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    online: StrictBool
    timestamp: int = Field(ge=0, strict=True)


class PrimaryHost:
    """Whether the host is online, as far as one connection to the broker has heard."""

    def __init__(self, name: str, namespace: str) -> None:
        self.awaited = f"the edge node waits for its primary host {name} to be online"
        self.topic = f"{namespace}/STATE/{name}"
        self.is_online = asyncio.Event()
        self._timestamp_ms = 0

    def forget(self) -> None:
        """Know nothing: a new connection hears again what the broker keeps."""
        self.is_online.clear()
        self._timestamp_ms = 0

    def hear(self, payload: bytes) -> None:
        """Take a message. What is garbled, or older than the latest one, is left alone."""
        try:
            state = HostState.model_validate_json(payload)
        except ValidationError as error:
            log.warning("a STATE of Sparkplug cannot be read", topic=self.topic, errors=error.error_count())
            return
        if state.timestamp < self._timestamp_ms:
            return
        self._timestamp_ms = state.timestamp
        if state.online:
            self.is_online.set()
        else:
            self.is_online.clear()
