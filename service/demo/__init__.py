"""The demo: a simulated plant, a service that watches it, and its diagnoses beside the truth."""

from pathlib import Path

MOTORS = Path(__file__).with_name("motors.toml")
SCENARIO = Path(__file__).with_name("scenario.toml")

__all__ = ["MOTORS", "SCENARIO"]
