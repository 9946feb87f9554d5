"""Samples the values that a relay measures at a set period, many with one request where it can do that.

A relay that refuses a request of many values, or ends the link at its first one, is asked for one value after
the other from then on.
"""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby

import structlog

from mms import (
    AccessDenied,
    Client,
    FunctionalConstraint,
    MmsError,
    NotFound,
    RequestRejected,
    ServiceFailed,
    TemporarilyUnavailable,
    Value,
)
from service.plant import Measurand, Relay
from service.storage.records import Sample

log = structlog.get_logger(__name__)

LARGEST_POWER_OF_TEN = 24
"""The largest multiplier of IEC 61850-7-3 is yotta."""

STATISTICS_PERIOD_S = 60.0
"""The relay's own statistics, which are many and change slowly, are sampled this often."""

MOST_TOGETHER = 20
"""Values of one request. Names of 40 octets fill a kilobyte; the smallest relays take two."""

NOT_OFFERED = (AccessDenied, NotFound)
REFUSALS = (*NOT_OFFERED, ServiceFailed, TemporarilyUnavailable)


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
        self._reads_together: bool | None = None  # not tried yet
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
        wanted = [one for one in self._offered if with_statistics or not one.quantity.is_statistic]
        values: dict[str, float] = {}
        left_out: dict[Measurand, str] = {}
        gone: set[Measurand] = set()
        for measurand, found in self._read(client, wanted):
            try:
                if isinstance(found, MmsError):
                    raise found
                factor = self._factor(client, measurand)
            except NOT_OFFERED as error:
                left_out[measurand] = str(error)
                gone.add(measurand)
            except ServiceFailed as error:
                left_out[measurand] = str(error)
            except TemporarilyUnavailable:
                pass
            else:
                if isinstance(found, int | float) and math.isfinite(found):
                    values[measurand.quantity] = float(found) * factor
        self._offered = tuple(one for one in self._offered if one not in gone)
        self._log_missing(left_out)
        return values

    def _read(
        self, client: Client, measurands: Iterable[Measurand]
    ) -> Iterator[tuple[Measurand, Value | MmsError]]:
        """Yield each with its value, or with why the relay gives none. Raises MmsError (the link)."""
        for part in _parts(measurands):
            together = self._read_together(client, part) if len(part) > 1 else None
            if together is not None:
                yield from zip(part, together, strict=True)
            else:
                for one in part:
                    yield one, _read_alone(client, one.reference)

    def _read_together(
        self, client: Client, measurands: Sequence[Measurand]
    ) -> tuple[Value | MmsError, ...] | None:
        """Return what one request gives; None where the relay cannot do that. Raises MmsError (the link)."""
        if self._reads_together is False:
            return None
        try:
            found = client.read_together([one.reference for one in measurands], FunctionalConstraint.MX)
        except (*REFUSALS, RequestRejected) as error:
            # One that has given many before is only busy now.
            self._reads_together = self._reads_together or False
            log.info("the relay gives one value at a time", relay=self._relay.name, reason=str(error))
            return None
        except MmsError:
            # A relay that ends the link at its first such request is not asked so again when it is back.
            self._reads_together = self._reads_together or False
            raise
        self._reads_together = True
        return found

    def _factor(self, client: Client, measurand: Measurand) -> float:
        """Return by how much the relay's values have to be multiplied for plain units."""
        if measurand not in self._factors:
            self._factors[measurand] = _factor_of(client, measurand)
        return self._factors[measurand]

    def _log_missing(self, reasons: Mapping[Measurand, str]) -> None:
        """Log what is missing, once a connection."""
        new = {each.quantity: reason for each, reason in reasons.items() if each not in self._logged}
        self._logged.update(reasons)
        if new:
            log.warning(
                "not measured by the relay, though its model says so", relay=self._relay.name, missing=new
            )


def _parts(measurands: Iterable[Measurand]) -> Iterator[Sequence[Measurand]]:
    """Yield them in parts of one logical device each, not too many together."""
    for _, group in groupby(measurands, key=lambda one: one.reference.partition("/")[0]):
        of_device = list(group)
        for begin in range(0, len(of_device), MOST_TOGETHER):
            yield of_device[begin : begin + MOST_TOGETHER]


def _read_alone(client: Client, reference: str) -> Value | MmsError:
    try:
        return client.read(reference, FunctionalConstraint.MX)
    except REFUSALS as error:
        return error


def _factor_of(client: Client, measurand: Measurand) -> float:
    if measurand.multiplier is None:
        return 1.0
    try:
        power = client.read(measurand.multiplier, FunctionalConstraint.CF)
    except NOT_OFFERED:
        return 1.0
    usable = isinstance(power, int) and abs(power) <= LARGEST_POWER_OF_TEN
    return 10.0**power if usable and isinstance(power, int) else 1.0
