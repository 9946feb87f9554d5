"""The version of all rules by which motors are judged."""

from typing import Final

LAYOUT: Final = 10
"""Version of a follower's saved state; another layout gets another number."""
RULES: Final = f"{LAYOUT}.1"
"""Whoever changes what is said of the same records raises the number after the dot, if not that of the
layout: stored conditions of another version are judged again from their observations."""
