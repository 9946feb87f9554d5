"""Classes of sensors that are typical of relay models, for motors whose file names none.

What a manufacturer publishes is the accuracy of the relay alone. The instrument transformers come on top, and
no SCL tells theirs. So a class is never better than the default one, 1 % and 25 us either way, and it is
worse where a relay's own accuracy is.
"""

from dataclasses import dataclass

from core.machines.sensors import SensorClass


@dataclass(frozen=True, slots=True)
class RelayModel:
    """A family of relays: how its SCL names it, and the class of its channels.

    manufacturer, type: how the SCL's names begin, in capitals.
    published: gains that the manufacturer publishes, in words.
    """

    manufacturer: str
    type: str
    published: str
    sensors: SensorClass


RELAY_MODELS = (
    RelayModel("ABB", "REM6", "currents and voltages 0.5 %", SensorClass()),
    RelayModel("GE", "M60", "currents and voltages 0.5 %", SensorClass()),
    RelayModel("SCHNEIDER", "P24", "1 %", SensorClass()),
    RelayModel("SIEMENS", "7SK80", "currents 1.5 %, voltages 1 %", SensorClass(current_gain=0.015)),
)
"""Sources are in docs/reference/motor-file.md."""


def typical_sensors(manufacturer: str, relay_type: str) -> SensorClass:
    """Return the class that is typical of a relay; the default one where its model is not known."""
    made_by, model = manufacturer.strip().upper(), relay_type.strip().upper()
    for known in RELAY_MODELS:
        if made_by.startswith(known.manufacturer) and model.startswith(known.type):
            return known.sensors
    return SensorClass()
