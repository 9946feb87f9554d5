"""What the relays measured."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sample:
    """What a relay measured at a time: values by the names of Measurement's fields, those it has."""

    motor: str
    time_ns: int
    values: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Measurement:
    """Measured values, or means of `samples` of them from `time_ns` on; None where the relay has none.

    average_..., maximum_..., minimum_...: the relay's own statistics; of several, the largest maximum and the
    smallest minimum.
    """

    time_ns: int
    samples: int
    ia_A: float | None
    ib_A: float | None
    ic_A: float | None
    vab_V: float | None
    vbc_V: float | None
    vca_V: float | None
    va_V: float | None
    vb_V: float | None
    vc_V: float | None
    power_W: float | None
    reactive_power_var: float | None
    power_factor: float | None
    frequency_Hz: float | None
    average_current_A: float | None
    maximum_current_A: float | None
    minimum_current_A: float | None
    average_voltage_V: float | None
    maximum_voltage_V: float | None
    minimum_voltage_V: float | None
    average_power_W: float | None
    maximum_power_W: float | None
    minimum_power_W: float | None
    maximum_ia_A: float | None
    maximum_ib_A: float | None
    maximum_ic_A: float | None
    minimum_ia_A: float | None
    minimum_ib_A: float | None
    minimum_ic_A: float | None
    maximum_vab_V: float | None
    maximum_vbc_V: float | None
    maximum_vca_V: float | None
    minimum_vab_V: float | None
    minimum_vbc_V: float | None
    minimum_vca_V: float | None
