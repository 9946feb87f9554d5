"""A relay's values as its clients see them: statuses by their key in the profile, and metered values."""

import cmath
from math import degrees

import numpy as np

from core.units import NANOSECONDS_PER_SECOND
from ied_sim.monitoring.metering import Metering, metered_values
from ied_sim.relay.points import RelayPoints
from ied_sim.relay.server import RelayServer
from mms import Value


class RelayValues:
    """Publishes the values on one relay's server.

    `refresh_s` is the longest time until metered values that have not changed are published again.
    """

    def __init__(
        self,
        server: RelayServer,
        points: RelayPoints,
        *,
        refresh_s: float,
    ) -> None:
        self._refresh_s = refresh_s
        self._server = server
        self._points = points
        self._nodes = points.metering, points.sequence
        nothing = Metering(0.0, np.zeros(3, complex), np.zeros(3, complex), 1)
        self._measured = [name for name in self._measurements(nothing) if points.is_measurand(name)]
        self._published, self._published_ns = nothing, 0

    def publish_status(self, values: dict[str, Value], time_ns: int) -> None:
        """Publish statuses by their key; those the profile does not name are left out."""
        named = {self._points.value_of(key): value for key, value in values.items()}
        found = {reference: value for reference, value in named.items() if reference is not None}
        if found:
            self._server.publish(found, time_ns)

    def publish_controls(self, values: dict[str, bool], time_ns: int) -> None:
        """Publish the state of controls by their reference."""
        statuses = {self._points.status_of(reference): value for reference, value in values.items()}
        found = {reference: value for reference, value in statuses.items() if reference is not None}
        if found:
            self._server.publish(found, time_ns)

    def publish_metering(self, metering: Metering, time_ns: int) -> None:
        """Publish all metered values."""
        self._published, self._published_ns = metering, time_ns
        values = self._measurements(metering)
        self._server.publish({name: values[name] for name in self._measured}, time_ns)

    def refresh_metering(self, metering: Metering, time_ns: int) -> None:
        """Publish metered values that have changed, and unchanged ones now and then."""
        refresh_ns = self._refresh_s * NANOSECONDS_PER_SECOND
        if metering is not self._published or time_ns - self._published_ns >= refresh_ns:
            self.publish_metering(metering, time_ns)

    def _measurements(self, metering: Metering) -> dict[str, Value]:
        """Return every attribute that a metering data object may have, by reference."""
        attributes: dict[str, Value] = {}
        for inst_reference, value in metered_values(metering, *self._nodes).items():
            reference = self._points.reference(inst_reference)
            if isinstance(value, complex):
                for vector in ("instCVal", "cVal"):
                    attributes[f"{reference}.{vector}.mag.f"] = abs(value)
                    attributes[f"{reference}.{vector}.ang.f"] = degrees(cmath.phase(value))
            else:
                for magnitude in ("instMag", "mag"):
                    attributes[f"{reference}.{magnitude}.f"] = value
        return attributes
