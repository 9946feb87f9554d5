"""The relay's protection of the motor: overcurrent, unbalance, thermal overload.

The elements look at metered currents at intervals, not at samples: a trip comes up to one interval late.
"""

from dataclasses import dataclass

from ied_sim.monitoring.metering import Metering

NEGATIVE_SEQUENCE_HEATING = 3.0
"""Heating of a negative-sequence current over that of a positive one (NEMA MG-1, commonly 3 to 6)."""


@dataclass(frozen=True, slots=True)
class DefiniteTime:
    """Element that trips when the value has been above `pickup` for `delay_s`."""

    pickup: float
    delay_s: float = 0.0


@dataclass(frozen=True, slots=True)
class ThermalOverload:
    """Element that trips when the thermal image is full.

    A steady current of `service_factor` times the rated one fills it.
    """

    service_factor: float = 1.15
    time_constant_s: float = 600.0


@dataclass(frozen=True, slots=True)
class ProtectionSettings:
    """Elements in use: overcurrent in multiples of the rated current, unbalance as |I2| / |I1|."""

    overcurrent: DefiniteTime | None = None
    unbalance: DefiniteTime | None = None
    thermal: ThermalOverload | None = None


class Protection:
    """State of the elements; used by one thread."""

    def __init__(self, settings: ProtectionSettings, rated_current_A: float) -> None:
        self._settings = settings
        self._rated_A = rated_current_A
        self._above_since: dict[str, float] = {}
        self._updated_s: float | None = None
        self.thermal_capacity = 0.0
        """How full the thermal image is, 1 at the trip; stays 0 where the element is not in use."""

    def update(self, metering: Metering, time_s: float) -> list[str]:
        """Return the names of the elements that trip now: "overcurrent", "unbalance", "thermal"."""
        settings = self._settings
        multiple = metering.current_A / self._rated_A
        tripped = []
        if settings.overcurrent and self._times_out("overcurrent", multiple, settings.overcurrent, time_s):
            tripped.append("overcurrent")
        # Below a quarter of the rated current the ratio says little, so the element is blocked there.
        unbalance = metering.unbalance if multiple > 0.25 else 0.0
        if settings.unbalance and self._times_out("unbalance", unbalance, settings.unbalance, time_s):
            tripped.append("unbalance")
        if settings.thermal:
            self._heat(settings.thermal, multiple, metering.unbalance, time_s)
            if self.thermal_capacity >= 1.0:
                tripped.append("thermal")
        self._updated_s = time_s
        return tripped

    def _times_out(self, name: str, value: float, element: DefiniteTime, time_s: float) -> bool:
        if value <= element.pickup:
            self._above_since.pop(name, None)
            return False
        return time_s - self._above_since.setdefault(name, time_s) >= element.delay_s

    def _heat(self, element: ThermalOverload, multiple: float, unbalance: float, time_s: float) -> None:
        """Update the first-order thermal image (IEC 60255-149).

        It follows I1^2 + K I2^2, in units of the current it trips at.
        """
        if self._updated_s is None:
            return
        equivalent = multiple**2 * (1 + NEGATIVE_SEQUENCE_HEATING * unbalance**2) / element.service_factor**2
        share = min(1.0, (time_s - self._updated_s) / element.time_constant_s)
        self.thermal_capacity += (equivalent - self.thermal_capacity) * share
