"""The table [gateways] of the settings: a gateway runs where its table is there."""

from collections.abc import Sequence

from pydantic import BaseModel, ConfigDict

from service.configuration.gateways.goose import GooseSettings
from service.configuration.gateways.iec104 import Iec104Settings
from service.configuration.gateways.iec61850 import Iec61850Settings
from service.configuration.gateways.modbus import ModbusSettings
from service.configuration.gateways.mqtt import MqttSettings
from service.configuration.gateways.opcua import OpcUaSettings


class GatewaysSettings(BaseModel):
    """Each of them is off unless its table is given."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    goose: GooseSettings | None = None
    iec104: Iec104Settings | None = None
    iec61850: Iec61850Settings | None = None
    modbus: ModbusSettings | None = None
    mqtt: MqttSettings | None = None
    opcua: OpcUaSettings | None = None

    @property
    def configured(self) -> Sequence[str]:
        """Return the kinds of the gateways that are to run."""
        return [kind for kind in type(self).model_fields if getattr(self, kind) is not None]
