"""Who does something, and what they may: people, programs with a token of theirs, parts of the service."""

from dataclasses import dataclass
from typing import Final

from service.roles import Role

COMMAND_LINE: Final = "command line"
"""The origin of what the owner of the service's files does in its database. No address reads so."""


@dataclass(frozen=True, slots=True)
class Actor:
    """Who asks for a change, for what is kept of it.

    origin: the address a request came from, COMMAND_LINE, or "service" for what the service does itself.
    """

    name: str
    origin: str
    roles: frozenset[Role] = frozenset()

    @property
    def owns_files(self) -> bool:
        """Return whether this is the owner of the service's files, who does not come over the network."""
        return self.origin == COMMAND_LINE


SERVICE = Actor("statorwatch", "service")
"""The service itself: schedules, retention, alarms that end by themselves."""
