"""What the demo can play: a scenario of the simulator, and the service's files and settings for it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from service.demo import MONTH, MONTH_MOTORS, MOTORS, SCENARIO


@dataclass(frozen=True, slots=True)
class Play:
    """A scenario with the motors file and further settings of the service that watches it."""

    scenario: Path
    motors: Path
    settings: Mapping[str, str] = field(default_factory=dict)


STEADY = Play(SCENARIO, MOTORS)
"""Motors that stay as they are, some of them faulty."""

MONTH_OF_CHANGES = Play(
    MONTH,
    MONTH_MOTORS,
    {"MCC_STALE_AFTER_DAYS": "60", "MCC_TEXT_REPORT_PERIOD_S": "0", "MCC_LONG_RECORD_DAYS": "0"},
)
"""A month in which a fault and a sensor develop. Its records are up to a month old, and are not stale.

Text reports are not fetched, and no long records are made: the clocks leap."""
