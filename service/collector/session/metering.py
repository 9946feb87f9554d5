"""Samples the values that a relay measures, one request after the other, at a set period."""

import math
import time
from collections.abc import Callable, Mapping

import structlog

from mms import (
    AccessDenied,
    Client,
    FunctionalConstraint,
    NotFound,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.plant import Measurand, Relay
from service.storage.records import Sample

log = structlog.get_logger(__name__)

LARGEST_POWER_OF_TEN = 24
"""The largest multiplier of IEC 61850-7-3 is yotta."""

STATISTICS_PERIOD_S = 60.0
"""The relay's own statistics, which are many and change slowly, are sampled this often."""

NOT_OFFERED = (AccessDenied, NotFound)


class Metering:
    """Samples one relay. Used by that relay's session alone.

    A value that the model promises and the relay does not have is left out until the next connection. A value
    that the relay has and cannot give is left out of that sample. Both are logged.
    """

    def __init__(
        self, relay: Relay, motor: str, *, period_s: float, on_sample: Callable[[Sample], None]
    ) -> None:
        """Sample what the relay's model promises, until a connection tells what it offers.

        period_s: between samples; 0 where none is wanted.  on_sample: takes each sample.
        """
        self._relay = relay
        self._measurands = relay.measurands
        self._motor = motor
        self._period_s = period_s
        self._on_sample = on_sample
        self._offered = self._measurands
        self._factors: dict[Measurand, float] = {}
        self._logged: set[Measurand] = set()
        self._next_s = 0.0
        self._next_statistics_s = 0.0
        self._took_s = {True: 0.0, False: 0.0}

    def begin(self, measurands: tuple[Measurand, ...] | None = None) -> None:
        """Begin a new connection. measurands: what the relay offers; None where what is known still holds."""
        if measurands is not None:
            self._measurands = measurands
        self._offered = self._measurands
        self._factors = {}
        self._logged = set()
        self._next_s = time.monotonic()

    def due_in_s(self) -> float:
        """Return the time until the next sample [s]; infinite where none is wanted."""
        wanted = self._period_s > 0 and self._offered
        return max(0.0, self._next_s - time.monotonic()) if wanted else math.inf

    def takes_s(self) -> float:
        """Return how long the next sample takes, by the latest of its kind [s]; 0 before the first."""
        return self._took_s[self._has_statistics_due()]

    def _has_statistics_due(self) -> bool:
        return time.monotonic() >= self._next_statistics_s

    def sample(self, client: Client) -> None:
        """Take a sample now. Raises MmsError (the link)."""
        began_s = time.monotonic()
        self._next_s += self._period_s
        if self._next_s < time.monotonic():
            # What was missed, because a long record was pulled meanwhile, is not made up for.
            self._next_s = time.monotonic() + self._period_s
        with_statistics = self._has_statistics_due()
        if with_statistics:
            self._next_statistics_s = time.monotonic() + STATISTICS_PERIOD_S
        values = self._values(client, with_statistics=with_statistics)
        self._took_s[with_statistics] = time.monotonic() - began_s
        if values:
            self._on_sample(Sample(self._motor, time.time_ns(), values))

    def _values(self, client: Client, *, with_statistics: bool) -> dict[str, float]:
        values: dict[str, float] = {}
        left_out: dict[Measurand, str] = {}
        offered = []
        for measurand in self._offered:
            try:
                if with_statistics or not measurand.quantity.is_statistic:
                    value = self._value(client, measurand)
                    if value is not None:
                        values[measurand.quantity] = value
            except NOT_OFFERED as error:
                left_out[measurand] = str(error)
                continue
            except ServiceFailed as error:
                left_out[measurand] = str(error)
            except TemporarilyUnavailable:
                pass
            offered.append(measurand)
        self._offered = tuple(offered)
        self._log_missing(left_out)
        return values

    def _value(self, client: Client, measurand: Measurand) -> float | None:
        """Read a value in plain units; None where it is no number."""
        value = client.read(measurand.reference, FunctionalConstraint.MX)
        if measurand not in self._factors:
            self._factors[measurand] = _factor(client, measurand)
        if isinstance(value, int | float) and math.isfinite(value):
            return float(value) * self._factors[measurand]
        return None

    def _log_missing(self, reasons: Mapping[Measurand, str]) -> None:
        """Log what is missing, once a connection."""
        new = {each.quantity: reason for each, reason in reasons.items() if each not in self._logged}
        self._logged.update(reasons)
        if new:
            log.warning(
                "not measured by the relay, though its model says so", relay=self._relay.name, missing=new
            )


def _factor(client: Client, measurand: Measurand) -> float:
    if measurand.multiplier is None:
        return 1.0
    try:
        power = client.read(measurand.multiplier, FunctionalConstraint.CF)
    except NOT_OFFERED:
        return 1.0
    usable = isinstance(power, int) and abs(power) <= LARGEST_POWER_OF_TEN
    return 10.0**power if usable and isinstance(power, int) else 1.0
