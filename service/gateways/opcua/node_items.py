"""Nodes and references as a server is asked to add them: many at once, each with all of its attributes.

The library's own functions ask for one node at a time, and write what differs from their defaults later.
"""

from collections.abc import Sequence
from typing import Final

from asyncua import Server, ua

HAS_ADD_IN: Final = ua.ObjectIds.HasAddIn
HAS_COMPONENT: Final = ua.ObjectIds.HasComponent
HAS_INTERFACE: Final = ua.ObjectIds.HasInterface
HAS_NOTIFIER: Final = ua.ObjectIds.HasNotifier
HAS_PROPERTY: Final = ua.ObjectIds.HasProperty
HAS_SUBTYPE: Final = ua.ObjectIds.HasSubtype
ORGANIZES: Final = ua.ObjectIds.Organizes

BOTH_WAYS: Final = frozenset(map(ua.NodeId, (HAS_ADD_IN, HAS_COMPONENT)))

FOLDER: Final = ua.NodeId(ua.ObjectIds.FolderType)
READ: Final = ua.AccessLevel.CurrentRead.mask
READ_HISTORY: Final = READ | ua.AccessLevel.HistoryRead.mask


def object_item(
    node_id: ua.NodeId,
    name: ua.QualifiedName,
    parent: ua.NodeId,
    reference: int,
    type_definition: ua.NodeId = FOLDER,
    *,
    description: str = "",
    is_notifier: bool = False,
) -> ua.AddNodesItem:
    """Return an object below its parent. is_notifier: clients can subscribe to its events."""
    attributes = ua.ObjectAttributes(
        DisplayName=ua.LocalizedText(name.Name),
        Description=ua.LocalizedText(description or name.Name),
        EventNotifier=ua.EventNotifier.SubscribeToEvents.mask if is_notifier else 0,
    )
    return _item(node_id, name, parent, reference, ua.NodeClass.Object, attributes, type_definition)


def variable_item(
    node_id: ua.NodeId,
    name: ua.QualifiedName,
    parent: ua.NodeId,
    value: ua.Variant,
    data_type: ua.NodeId,
    *,
    is_property: bool = False,
    has_history: bool = False,
    type_definition: int = ua.ObjectIds.BaseDataVariableType,
    description: str = "",
) -> ua.AddNodesItem:
    """Return a variable or a property of a node, which clients may read."""
    access = READ_HISTORY if has_history else READ
    attributes = ua.VariableAttributes(
        DisplayName=ua.LocalizedText(name.Name),
        Description=ua.LocalizedText(description or name.Name),
        Value=value,
        DataType=data_type,
        ValueRank=ua.ValueRank.OneDimension if isinstance(value.Value, list) else ua.ValueRank.Scalar,
        ArrayDimensions=None,
        AccessLevel=access,
        UserAccessLevel=access,
        Historizing=has_history,
    )
    kind = ua.ObjectIds.PropertyType if is_property else type_definition
    reference = HAS_PROPERTY if is_property else HAS_COMPONENT
    return _item(node_id, name, parent, reference, ua.NodeClass.Variable, attributes, ua.NodeId(kind))


def object_type_item(
    node_id: ua.NodeId, name: ua.QualifiedName, supertype: ua.NodeId, *, is_abstract: bool = False
) -> ua.AddNodesItem:
    """Return a type of objects below the type that it refines."""
    attributes = ua.ObjectTypeAttributes(
        DisplayName=ua.LocalizedText(name.Name),
        Description=ua.LocalizedText(name.Name),
        IsAbstract=is_abstract,
    )
    return _item(node_id, name, supertype, HAS_SUBTYPE, ua.NodeClass.ObjectType, attributes, ua.NodeId())


def reference_item(source: ua.NodeId, reference: int, target: ua.NodeId) -> ua.AddReferencesItem:
    """Return a reference from one node to another; both have to be there."""
    return ua.AddReferencesItem(
        SourceNodeId=source,
        ReferenceTypeId=ua.NodeId(reference),
        IsForward=True,
        TargetNodeId=target,
        TargetNodeClass=ua.NodeClass.Unspecified,
    )


async def add(
    server: Server, nodes: Sequence[ua.AddNodesItem], references: Sequence[ua.AddReferencesItem] = ()
) -> None:
    """Add nodes, then references; those of what is below something both ways.

    Raises
    ------
    UaStatusCodeError
        One could not be added.
    """
    for added in await server.iserver.isession.add_nodes(nodes):
        added.StatusCode.check()
    both = [*references, *(_inverse(one) for one in references if one.ReferenceTypeId in BOTH_WAYS)]
    for status in await server.iserver.isession.add_references(both):
        status.check()


async def delete(server: Server, nodes: Sequence[ua.NodeId], parents: Sequence[ua.NodeId]) -> None:
    """Delete nodes, and the references of their parents to them.

    The library would look for references to each in all nodes of the server. It would also leave clients that
    are told of a value with the last one; they are told that the node is unknown.
    """
    gone = set(nodes)
    for node in nodes:
        await _tell_gone(server, node)
    for parent in parents:
        references = await server.get_node(parent).get_references(direction=ua.BrowseDirection.Forward)
        ended = [
            ua.DeleteReferencesItem(
                SourceNodeId=parent,
                ReferenceTypeId=one.ReferenceTypeId,
                IsForward=True,
                TargetNodeId=one.NodeId,
                DeleteBidirectional=False,
            )
            for one in references
            if one.NodeId in gone
        ]
        for status in await server.iserver.isession.delete_references(ended):
            status.check()
    items = [ua.DeleteNodesItem(NodeId=one, DeleteTargetReferences=False) for one in nodes]
    for status in await server.iserver.isession.delete_nodes(ua.DeleteNodesParameters(NodesToDelete=items)):
        status.check()


async def _tell_gone(server: Server, node: ua.NodeId) -> None:
    space = server.iserver.aspace
    value = space[node].attributes.get(ua.AttributeIds.Value)
    if value is not None and value.datachange_callbacks:
        unknown = ua.DataValue(StatusCode=ua.StatusCode(ua.StatusCodes.BadNodeIdUnknown))
        (await space.write_attribute_value(node, ua.AttributeIds.Value, unknown)).check()
        for handle in tuple(value.datachange_callbacks):
            space.delete_datachange_callback(handle)


def _inverse(one: ua.AddReferencesItem) -> ua.AddReferencesItem:
    return ua.AddReferencesItem(
        SourceNodeId=one.TargetNodeId,
        ReferenceTypeId=one.ReferenceTypeId,
        IsForward=False,
        TargetNodeId=one.SourceNodeId,
        TargetNodeClass=ua.NodeClass.Unspecified,
    )


def _item(
    node_id: ua.NodeId,
    name: ua.QualifiedName,
    parent: ua.NodeId,
    reference: int,
    node_class: ua.NodeClass,
    attributes: object,
    type_definition: ua.NodeId,
) -> ua.AddNodesItem:
    return ua.AddNodesItem(
        ParentNodeId=parent,
        ReferenceTypeId=ua.NodeId(reference),
        RequestedNewNodeId=node_id,
        BrowseName=name,
        NodeClass=node_class,
        NodeAttributes=attributes,
        TypeDefinition=type_definition,
    )
