"""The relay's protection of the motor: overcurrent, unbalance, thermal overload.

It looks at the metered currents every so often, not at samples: trips come up to one look late.
"""

from dataclasses import dataclass

from ied_sim.monitoring.metering import Metering

NEGATIVE_SEQUENCE_HEATING = 3.0
"""How much more a negative-sequence current heats than a positive one (NEMA MG-1, commonly 3 to 6)."""


@dataclass(frozen=True, slots=True)
class DefiniteTime:
    """Trips when the value has been above `pickup` for `delay_s`."""

    pickup: float
    delay_s: float = 0.0


@dataclass(frozen=True, slots=True)
class ThermalOverload:
    """Trips when the thermal image is full: steady current of service_factor times the rated one."""

    service_factor: float = 1.15
    time_constant_s: float = 600.0


@dataclass(frozen=True, slots=True)
class ProtectionSettings:
    """Elements in use: overcurrent in multiples of the rated current, unbalance as |I2| / |I1|."""

    overcurrent: DefiniteTime | None = None
    unbalance: DefiniteTime | None = None
    thermal: ThermalOverload | None = None


class Protection:
    """The elements' state; used by one thread."""

    def __init__(self, settings: ProtectionSettings, rated_current_A: float) -> None:
        self._settings = settings
        self._rated_A = rated_current_A
        self._above_since: dict[str, float] = {}
        self._looked_s: float | None = None
        self.thermal_capacity = 0.0
        """How full the thermal image is, 1 at the trip; stays 0 where the element is not in use."""

    def look(self, seen: Metering, time_s: float) -> list[str]:
        """Names of the elements that trip now: "overcurrent", "unbalance", "thermal"."""
        settings = self._settings
        multiple = seen.current_A / self._rated_A
        tripped = []
        if settings.overcurrent and self._times_out("overcurrent", multiple, settings.overcurrent, time_s):
            tripped.append("overcurrent")
        # Below a quarter of the rated current the ratio says little: the element is blocked there.
        unbalance = seen.unbalance if multiple > 0.25 else 0.0
        if settings.unbalance and self._times_out("unbalance", unbalance, settings.unbalance, time_s):
            tripped.append("unbalance")
        if settings.thermal:
            self._heat(settings.thermal, multiple, seen.unbalance, time_s)
            if self.thermal_capacity >= 1.0:
                tripped.append("thermal")
        self._looked_s = time_s
        return tripped

    def _times_out(self, name: str, value: float, element: DefiniteTime, time_s: float) -> bool:
        if value <= element.pickup:
            self._above_since.pop(name, None)
            return False
        return time_s - self._above_since.setdefault(name, time_s) >= element.delay_s

    def _heat(self, element: ThermalOverload, multiple: float, unbalance: float, time_s: float) -> None:
        """First-order image (IEC 60255-149) of I1^2 + K I2^2, in units of the current it trips at."""
        if self._looked_s is None:
            return
        equivalent = multiple**2 * (1 + NEGATIVE_SEQUENCE_HEATING * unbalance**2) / element.service_factor**2
        share = min(1.0, (time_s - self._looked_s) / element.time_constant_s)
        self.thermal_capacity += (equivalent - self.thermal_capacity) * share
