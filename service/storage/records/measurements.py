"""What the relays measured."""

from collections.abc import Mapping
from dataclasses import dataclass

from service.storage.states import MeasurementSource


@dataclass(frozen=True, slots=True)
class Sample:
    """What a relay measured at a time: those values it has, by the names of MeteredQuantity."""

    motor: str
    time_ns: int
    values: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Measurement:
    """Measured values, or means of `samples` of them from `time_ns` on.

    values: by the names of MeteredQuantity; None where the relay has none.

    average_..., maximum_..., minimum_...: the relay's own statistics; of several, the largest maximum and the
    smallest minimum.
    """

    time_ns: int
    samples: int
    values: Mapping[str, float | None]
    source: MeasurementSource = MeasurementSource.POLLED


@dataclass(frozen=True, slots=True)
class ImportedLoad:
    """How many rows of a load profile became measured values.

    known: in quarters of an hour that have measured values already.  not_over: in one that is not over, or
    ahead of the time.
    """

    added: int
    known: int
    not_over: int
