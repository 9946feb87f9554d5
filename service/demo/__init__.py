"""The demo: a simulated plant, the service that watches it, and what the one finds out about the other."""

from pathlib import Path

MOTORS = Path(__file__).with_name("motors.toml")
SCENARIO = Path(__file__).with_name("scenario.toml")

__all__ = ["MOTORS", "SCENARIO"]
