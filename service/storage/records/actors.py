"""Who does something, and what they may: people, programs with a token of theirs, parts of the service."""

from dataclasses import dataclass

from service.roles import Role


@dataclass(frozen=True, slots=True)
class Actor:
    """Who asks for a change, for what is kept of it.

    origin: the address a request came from, "command line", or "service" for what the service does itself.
    """

    name: str
    origin: str
    roles: frozenset[Role] = frozenset()


SERVICE = Actor("statorwatch", "service")
"""The service itself: schedules, retention, alarms that end by themselves."""
