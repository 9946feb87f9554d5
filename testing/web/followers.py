"""Pages that are told of changes."""

from fastapi import FastAPI

from service.web.live.routes import live_of
from testing.waiting import wait_until


def until_followed(app: FastAPI, streams: int) -> None:
    """Wait until so many pages are told of changes."""
    bus = live_of(app).bus
    wait_until(lambda: bus.streams == streams, f"{streams} pages that follow what happens")
