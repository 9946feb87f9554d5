"""Adds the types of the companion specifications to a server."""

from typing import Final

from asyncua import Server, ua

from service.gateways.opcua.companion_types import (
    DEVICE_HEALTH,
    EDITIONS,
    FIRST_TRANSITION,
    FIRST_TRANSITION_NUMBER,
    FOLDERS,
    HEALTH_ENUMERATION,
    HEALTH_FOLDER,
    HEALTH_NAMES,
    ITEM_STATE,
    LOCALIZED_TEXT,
    MONITORING,
    STATES,
    STRING,
    TRANSITIONS,
    TYPES,
    Edition,
    ObjectType,
)
from service.gateways.opcua.namespaces import DEVICES, MACHINERY, STANDARD, Namespaces
from service.gateways.opcua.node_items import (
    HAS_COMPONENT,
    HAS_INTERFACE,
    add,
    object_item,
    object_type_item,
    reference_item,
    variable_item,
)

MANDATORY: Final = ua.NodeId(ua.ObjectIds.ModellingRule_Mandatory)
OPTIONAL: Final = ua.NodeId(ua.ObjectIds.ModellingRule_Optional)


async def add_companion_types(server: Server, spaces: Namespaces) -> None:
    """Add the types, the states of machines, and what is said of the two namespaces."""
    await add(server, [_health_enumeration(spaces)])
    await add(
        server,
        [
            variable_item(
                spaces.node_id(DEVICES, 6450),
                spaces.name(STANDARD, "EnumStrings"),
                spaces.node_id(*HEALTH_ENUMERATION),
                ua.Variant([ua.LocalizedText(name) for name in HEALTH_NAMES], LOCALIZED_TEXT),
                ua.NodeId(ua.ObjectIds.LocalizedText),
                is_property=True,
            )
        ],
    )
    for one in TYPES:
        await _add_type(server, spaces, one)
    await _add_members(server, spaces)
    await _add_states(server, spaces)
    for edition in EDITIONS:
        await _add_edition(server, spaces, edition)


def _health_enumeration(spaces: Namespaces) -> ua.AddNodesItem:
    name = spaces.name(DEVICES, "DeviceHealthEnumeration")
    return ua.AddNodesItem(
        ParentNodeId=ua.NodeId(ua.ObjectIds.Enumeration),
        ReferenceTypeId=ua.NodeId(ua.ObjectIds.HasSubtype),
        RequestedNewNodeId=spaces.node_id(*HEALTH_ENUMERATION),
        BrowseName=name,
        NodeClass=ua.NodeClass.DataType,
        NodeAttributes=ua.DataTypeAttributes(
            DisplayName=ua.LocalizedText(name.Name),
            IsAbstract=False,
            DataTypeDefinition=ua.EnumDefinition(
                [
                    ua.EnumField(Value=number, DisplayName=ua.LocalizedText(one), Name=one)
                    for number, one in enumerate(HEALTH_NAMES)
                ]
            ),
        ),
    )


async def _add_type(server: Server, spaces: Namespaces, one: ObjectType) -> None:
    namespace, _ = one.place
    node = spaces.node_id(*one.place)
    nodes = [
        object_type_item(
            node,
            spaces.name(namespace, one.name),
            spaces.node_id(*one.supertype),
            is_abstract=one.is_abstract,
        )
    ]
    references = [
        reference_item(node, HAS_INTERFACE, spaces.node_id(*interface)) for interface in one.interfaces
    ]
    if one.instance is not None:
        number, space, text = one.instance
        nodes.append(
            variable_item(
                spaces.node_id(namespace, number),
                spaces.name(STANDARD, "DefaultInstanceBrowseName"),
                node,
                ua.Variant(spaces.name(space, text), ua.VariantType.QualifiedName),
                ua.NodeId(ua.ObjectIds.QualifiedName),
                is_property=True,
            )
        )
    for member in one.properties:
        member_id = spaces.node_id(namespace, member.number)
        initial = ua.Variant(ua.LocalizedText("") if member.kind is LOCALIZED_TEXT else "", member.kind)
        nodes.append(
            variable_item(
                member_id,
                spaces.name(member.namespace, member.name),
                node,
                initial,
                ua.NodeId(member.kind.value),
                is_property=True,
            )
        )
        references.append(_rule(member_id, is_mandatory=member.is_mandatory))
    await add(server, nodes, references)


def _rule(node: ua.NodeId, *, is_mandatory: bool) -> ua.AddReferencesItem:
    return reference_item(node, ua.ObjectIds.HasModellingRule, MANDATORY if is_mandatory else OPTIONAL)


async def _add_members(server: Server, spaces: Namespaces) -> None:
    """Add the health of a device, and the two folders of Monitoring that our machines have."""
    health, monitoring = spaces.node_id(DEVICES, 15052), spaces.node_id(*MONITORING)
    nodes = [
        variable_item(
            health,
            spaces.name(DEVICES, "DeviceHealth"),
            spaces.node_id(*DEVICE_HEALTH),
            ua.Variant(0, ua.VariantType.Int32),
            spaces.node_id(*HEALTH_ENUMERATION),
        ),
        *(
            object_item(
                spaces.node_id(MACHINERY, number), spaces.name(MACHINERY, name), monitoring, HAS_COMPONENT
            )
            for number, name in FOLDERS.items()
        ),
    ]
    references = [
        _rule(health, is_mandatory=False),
        *(_rule(spaces.node_id(MACHINERY, number), is_mandatory=False) for number in FOLDERS),
        reference_item(
            spaces.node_id(MACHINERY, HEALTH_FOLDER), HAS_INTERFACE, spaces.node_id(*DEVICE_HEALTH)
        ),
    ]
    await add(server, nodes, references)


async def _add_states(server: Server, spaces: Namespaces) -> None:
    machine = spaces.node_id(*ITEM_STATE)
    nodes = []
    references = []

    def numbered(node: int, name: str, kind: int, number_node: int, number_name: str, number: int) -> None:
        node_id = spaces.node_id(MACHINERY, node)
        nodes.append(
            object_item(node_id, spaces.name(MACHINERY, name), machine, HAS_COMPONENT, ua.NodeId(kind))
        )
        number_id = spaces.node_id(MACHINERY, number_node)
        nodes.append(
            variable_item(
                number_id,
                spaces.name(STANDARD, number_name),
                node_id,
                ua.Variant(number, ua.VariantType.UInt32),
                ua.NodeId(ua.ObjectIds.UInt32),
                is_property=True,
            )
        )
        references.append(_rule(number_id, is_mandatory=True))

    for name, (node, number_node, number) in STATES.items():
        numbered(node, name, ua.ObjectIds.StateType, number_node, "StateNumber", number)
    for place, (before, after, number) in enumerate(TRANSITIONS):
        node = FIRST_TRANSITION + place
        name = f"From{before}To{after}"
        numbered(
            node,
            name,
            ua.ObjectIds.TransitionType,
            FIRST_TRANSITION_NUMBER + place,
            "TransitionNumber",
            number,
        )
        for kind, state in ((ua.ObjectIds.FromState, before), (ua.ObjectIds.ToState, after)):
            references.append(
                reference_item(
                    spaces.node_id(MACHINERY, node), kind, spaces.node_id(MACHINERY, STATES[state][0])
                )
            )
    await add(server, nodes, references)


async def _add_edition(server: Server, spaces: Namespaces, edition: Edition) -> None:
    node = spaces.node_id(edition.namespace, edition.number)
    kinds = ua.ObjectIds
    told = (
        ("NamespaceUri", ua.Variant(edition.namespace, STRING), kinds.String),
        ("NamespaceVersion", ua.Variant(edition.version, STRING), kinds.String),
        (
            "NamespacePublicationDate",
            ua.Variant(edition.published, ua.VariantType.DateTime),
            kinds.DateTime,
        ),
        ("IsNamespaceSubset", ua.Variant(True, ua.VariantType.Boolean), kinds.Boolean),  # noqa: FBT003
        ("StaticNodeIdTypes", ua.Variant([ua.IdType.Numeric.value], ua.VariantType.Int32), kinds.IdType),
        ("StaticNumericNodeIdRange", ua.Variant([], STRING, is_array=True), kinds.NumericRange),
        ("StaticStringNodeIdPattern", ua.Variant("", STRING), kinds.String),
    )
    nodes = [
        object_item(
            node,
            spaces.name(edition.namespace, edition.namespace),
            ua.NodeId(ua.ObjectIds.Server_Namespaces),
            HAS_COMPONENT,
            ua.NodeId(ua.ObjectIds.NamespaceMetadataType),
        ),
        *(
            variable_item(
                spaces.node_id(edition.namespace, number),
                spaces.name(STANDARD, name),
                node,
                value,
                ua.NodeId(kind),
                is_property=True,
            )
            for number, (name, value, kind) in zip(edition.properties, told, strict=True)
        ),
    ]
    await add(server, nodes)
