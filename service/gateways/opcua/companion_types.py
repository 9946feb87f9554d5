"""The types of OPC 10000-100 and OPC 40001-1 that our nodes have, with their numbers and names.

Of each type there are the members that our nodes have; ``IsNamespaceSubset`` tells clients that there are
more. `benchmarks/gateways/node_sets.py` compares them with the node sets that the OPC Foundation publishes.
"""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Final

from asyncua import ua

from service.gateways.opcua.namespaces import DEVICES, MACHINERY, OURS, STANDARD

NodeKey = tuple[str, int | str]
"""Namespace and identifier of a node."""

LOCALIZED_TEXT, STRING = ua.VariantType.LocalizedText, ua.VariantType.String

HEALTH_ENUMERATION: Final = (DEVICES, 6244)
HEALTH_NAMES: Final = ("NORMAL", "FAILURE", "CHECK_FUNCTION", "OFF_SPEC", "MAINTENANCE_REQUIRED")
DEVICE_HEALTH: Final = (DEVICES, 15051)
MACHINES: Final = (MACHINERY, 1001)
ITEM_STATE: Final = (MACHINERY, 1002)
COMPONENT_IDENTIFICATION: Final = (MACHINERY, 1005)
MACHINE_IDENTIFICATION: Final = (MACHINERY, 1012)
MONITORING: Final = (MACHINERY, 1014)
NOTIFICATIONS: Final = (MACHINERY, 1017)
MOTOR: Final = (OURS, "MotorType")
RELAY: Final = (OURS, "RelayType")
FOLDER_TYPE: Final = (STANDARD, int(ua.ObjectIds.FolderType))
INTERFACE_TYPE: Final = (STANDARD, int(ua.ObjectIds.BaseInterfaceType))
STATE_MACHINE_TYPE: Final = (STANDARD, int(ua.ObjectIds.FiniteStateMachineType))
OBJECT_TYPE: Final = (STANDARD, int(ua.ObjectIds.BaseObjectType))


@dataclass(frozen=True, slots=True)
class Property:
    """A property of a type. number: in the type's namespace.  namespace: of its name."""

    number: int
    name: str
    kind: ua.VariantType
    namespace: str = DEVICES
    is_mandatory: bool = False


@dataclass(frozen=True, slots=True)
class ObjectType:
    """A type of objects.

    interfaces: that it has. instance: number of the property, and namespace and text, that say what its
    instances are called (DefaultInstanceBrowseName).
    """

    place: NodeKey
    name: str
    supertype: NodeKey
    is_abstract: bool = False
    interfaces: tuple[NodeKey, ...] = ()
    properties: tuple[Property, ...] = ()
    instance: tuple[int, str, str] | None = None


TYPES: Final = (
    ObjectType((DEVICES, 1005), "FunctionalGroupType", FOLDER_TYPE),
    ObjectType((DEVICES, 15035), "IVendorNameplateType", INTERFACE_TYPE, is_abstract=True, properties=(
        Property(15036, "Manufacturer", LOCALIZED_TEXT),
        Property(15038, "Model", LOCALIZED_TEXT),
        Property(15045, "SerialNumber", STRING),
        Property(15046, "ProductInstanceUri", STRING),
    )),
    ObjectType((DEVICES, 15048), "ITagNameplateType", INTERFACE_TYPE, is_abstract=True, properties=(
        Property(15050, "ComponentName", LOCALIZED_TEXT),
    )),
    ObjectType(DEVICE_HEALTH, "IDeviceHealthType", INTERFACE_TYPE, is_abstract=True),
    ObjectType(
        (MACHINERY, 1003), "IMachineryItemVendorNameplateType", (DEVICES, 15035), is_abstract=True,
        properties=(
            Property(6022, "Manufacturer", LOCALIZED_TEXT, is_mandatory=True),
            Property(6024, "SerialNumber", STRING, is_mandatory=True),
        ),
    ),
    ObjectType(
        (MACHINERY, 1010), "IMachineVendorNameplateType", (MACHINERY, 1003), is_abstract=True,
        properties=(Property(6023, "ProductInstanceUri", STRING, is_mandatory=True),),
    ),
    ObjectType((MACHINERY, 1011), "IMachineTagNameplateType", (DEVICES, 15048), is_abstract=True, properties=(
        Property(6028, "Location", STRING, MACHINERY),
    )),
    ObjectType(
        (MACHINERY, 1004), "MachineryItemIdentificationType", (DEVICES, 1005), is_abstract=True,
        interfaces=((MACHINERY, 1003), (DEVICES, 15048)), instance=(6088, DEVICES, "Identification"),
        properties=(
            Property(6001, "ProductInstanceUri", STRING),
            Property(6002, "Manufacturer", LOCALIZED_TEXT, is_mandatory=True),
            Property(6003, "SerialNumber", STRING, is_mandatory=True),
            Property(6008, "Model", LOCALIZED_TEXT),
            Property(6014, "ComponentName", LOCALIZED_TEXT),
        ),
    ),
    ObjectType(
        MACHINE_IDENTIFICATION, "MachineIdentificationType", (MACHINERY, 1004),
        interfaces=((MACHINERY, 1010), (MACHINERY, 1011)), instance=(6030, DEVICES, "Identification"),
        properties=(
            Property(6015, "ProductInstanceUri", STRING, is_mandatory=True),
            Property(6029, "Location", STRING, MACHINERY),
        ),
    ),
    ObjectType(
        COMPONENT_IDENTIFICATION, "MachineryComponentIdentificationType", (MACHINERY, 1004),
        instance=(6016, DEVICES, "Identification"),
    ),
    ObjectType(
        ITEM_STATE, "MachineryItemState_StateMachineType", STATE_MACHINE_TYPE,
        instance=(6021, MACHINERY, "MachineryItemState"),
    ),
    ObjectType(MONITORING, "MonitoringType", FOLDER_TYPE, instance=(6089, MACHINERY, "Monitoring")),
    ObjectType(NOTIFICATIONS, "NotificationsType", FOLDER_TYPE, instance=(6106, MACHINERY, "Notifications")),
    ObjectType(MOTOR, "MotorType", OBJECT_TYPE, interfaces=(DEVICE_HEALTH,)),
    ObjectType(RELAY, "RelayType", OBJECT_TYPE, interfaces=(DEVICE_HEALTH,)),
)  # fmt: skip

STATES: Final = {
    "OutOfService": (5004, 6038, 1),
    "NotAvailable": (5005, 6039, 0),
    "Executing": (5006, 6040, 3),
    "NotExecuting": (5007, 6041, 2),
}
"""States of a machine: number of the node, of its property StateNumber, and the value of that."""
TRANSITIONS: Final = (
    ("NotAvailable", "OutOfService", 0), ("NotAvailable", "NotExecuting", 2),
    ("NotAvailable", "Executing", 1), ("NotAvailable", "NotAvailable", 12),
    ("OutOfService", "NotAvailable", 3), ("OutOfService", "NotExecuting", 5),
    ("OutOfService", "Executing", 4), ("OutOfService", "OutOfService", 13),
    ("NotExecuting", "NotAvailable", 9), ("NotExecuting", "OutOfService", 10),
    ("NotExecuting", "Executing", 11), ("NotExecuting", "NotExecuting", 15),
    ("Executing", "NotAvailable", 6), ("Executing", "OutOfService", 7),
    ("Executing", "NotExecuting", 8), ("Executing", "Executing", 14),
)  # fmt: skip
"""From, to, and TransitionNumber, in the order of the nodes."""
FIRST_TRANSITION: Final = 5008
FIRST_TRANSITION_NUMBER: Final = 6042
"""Numbers of the first one's node, and of its property's; the others follow."""
HEALTH_FOLDER: Final = 5045
FOLDERS: Final = {5044: "Status", HEALTH_FOLDER: "Health"}
"""Folders of Monitoring that our machines have."""


@dataclass(frozen=True, slots=True)
class Edition:
    """What a companion specification says of its namespace, and the numbers of the nodes that say so."""

    namespace: str
    version: str
    published: datetime
    number: int
    properties: tuple[int, int, int, int, int, int, int]


EDITIONS: Final = (
    Edition(DEVICES, "1.05.0", datetime(2025, 11, 15, tzinfo=UTC), 15001,
            (15002, 15003, 15004, 15005, 15006, 15007, 15008)),
    Edition(MACHINERY, "1.04.1", datetime(2026, 1, 1, tzinfo=UTC), 5001,
            (6033, 6034, 6032, 6031, 6035, 6036, 6037)),
)  # fmt: skip
