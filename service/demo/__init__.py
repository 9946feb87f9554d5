"""The demo: a simulated plant, a service that watches it, and its diagnoses beside the truth."""

from pathlib import Path

MOTORS = Path(__file__).with_name("motors.toml")
SCENARIO = Path(__file__).with_name("scenario.toml")
MONTH = Path(__file__).with_name("month.toml")
"""Scenario of a month in which faults and sensors develop."""
MONTH_MOTORS = Path(__file__).with_name("month_motors.toml")
"""Its motors: those of MOTORS, with the buses that they share in that month."""

__all__ = ["MONTH", "MONTH_MOTORS", "MOTORS", "SCENARIO"]
