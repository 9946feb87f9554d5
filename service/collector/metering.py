"""Samples what a relay measures all the time, one request after the other, at a set period."""

import math
import time
from collections.abc import Callable, Mapping

import structlog

from mms import AccessDenied, Client, FunctionalConstraint, NotFound, TemporarilyUnavailable
from service.plant import Measurand, Relay
from service.storage.records import Sample

log = structlog.get_logger(__name__)

LARGEST_POWER_OF_TEN = 24
"""yotta; IEC 61850-7-3, multiplier."""

STATISTICS_PERIOD_S = 60.0
"""Least time between samples of the relay's own statistics, which change slowly and are many."""

NOT_OFFERED = (AccessDenied, NotFound)


class Metering:
    """Used by that relay's session alone. `on_sample` takes each sample; period_s = 0: none is taken.

    What the model promises and the relay does not have is left out for the length of a connection, and said.
    """

    def __init__(
        self, relay: Relay, motor: str, *, period_s: float, on_sample: Callable[[Sample], None]
    ) -> None:
        self._relay = relay
        self._measurands = relay.measurands
        self._motor = motor
        self._period_s = period_s
        self._on_sample = on_sample
        self._factors: dict[Measurand, float] | None = None
        self._next_s = 0.0
        self._next_statistics_s = 0.0

    def begin(self, measurands: tuple[Measurand, ...] | None = None) -> None:
        """A new connection: find out again what the relay offers, among what was found or is promised."""
        if measurands is not None:
            self._measurands = measurands
        self._factors = None
        self._next_s = time.monotonic()

    def due_in_s(self) -> float:
        """Until the next sample [s]; infinite where none is wanted."""
        wanted = self._period_s > 0 and self._measurands and self._factors != {}
        return max(0.0, self._next_s - time.monotonic()) if wanted else math.inf

    def sample(self, client: Client) -> None:
        """Take a sample now. Raises MmsError when the link fails."""
        self._next_s += self._period_s
        if self._next_s < time.monotonic():
            # What was missed, because a long record was pulled meanwhile, is not made up for.
            self._next_s = time.monotonic() + self._period_s
        if self._factors is None:
            self._factors = self._offered(client)
        values: dict[str, float] = {}
        with_statistics = time.monotonic() >= self._next_statistics_s
        if with_statistics:
            self._next_statistics_s = time.monotonic() + STATISTICS_PERIOD_S
        for measurand, factor in self._factors.items():
            if measurand.quantity.is_statistic and not with_statistics:
                continue
            try:
                value = client.read(measurand.reference, FunctionalConstraint.MX)
            except TemporarilyUnavailable:
                continue
            if isinstance(value, int | float) and math.isfinite(value):
                values[measurand.quantity] = float(value) * factor
        if values:
            self._on_sample(Sample(self._motor, time.time_ns(), values))

    def _offered(self, client: Client) -> dict[Measurand, float]:
        """What the relay has of what its model promises, and what each value is to be multiplied by."""
        offered: dict[Measurand, float] = {}
        missing: dict[str, str] = {}
        for measurand in self._measurands:
            try:
                client.read(measurand.reference, FunctionalConstraint.MX)
                offered[measurand] = _factor(client, measurand)
            except NOT_OFFERED as error:
                missing[measurand.quantity] = str(error)
            except TemporarilyUnavailable:
                offered[measurand] = _factor(client, measurand)
        _say(self._relay.name, missing)
        return offered


def _factor(client: Client, measurand: Measurand) -> float:
    if measurand.multiplier is None:
        return 1.0
    try:
        power = client.read(measurand.multiplier, FunctionalConstraint.CF)
    except NOT_OFFERED:
        return 1.0
    usable = isinstance(power, int) and abs(power) <= LARGEST_POWER_OF_TEN
    return 10.0**power if usable and isinstance(power, int) else 1.0


def _say(relay: str, missing: Mapping[str, str]) -> None:
    if missing:
        log.warning("not measured by the relay, though its model says so", relay=relay, missing=dict(missing))
