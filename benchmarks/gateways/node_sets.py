"""python -m benchmarks.gateways.node_sets FOLDER: our types beside the OPC Foundation's node sets.

FOLDER has Opc.Ua.Di.NodeSet2.xml and Opc.Ua.Machinery.NodeSet2.xml, as the OPC Foundation publishes them.
"""

import argparse
import asyncio
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from asyncua import Server, ua
from lxml import etree

from service.gateways.opcua.namespaces import DEVICES, MACHINERY, STANDARD, Namespaces
from service.gateways.opcua.type_nodes import add_companion_types

FILES = {DEVICES: "Opc.Ua.Di.NodeSet2.xml", MACHINERY: "Opc.Ua.Machinery.NodeSet2.xml"}
TAG = "{http://opcfoundation.org/UA/2011/03/UANodeSet.xsd}"
NodeKey = tuple[str, int]


@dataclass(frozen=True, slots=True)
class Described:
    """A node: its class and name, and what it refers to, as (number of the reference, forward, node)."""

    node_class: str
    name: tuple[str, str]
    data_type: NodeKey | None
    is_abstract: bool
    references: frozenset[tuple[int, bool, NodeKey]]


def published(path: Path) -> Mapping[NodeKey, Described]:
    """Return the nodes of a node set."""
    root = etree.parse(path, etree.XMLParser(resolve_entities=False, no_network=True)).getroot()
    uris = [STANDARD, *(str(one.text) for one in root.iterfind(f"{TAG}NamespaceUris/{TAG}Uri"))]
    aliases = {one.get("Alias"): str(one.text) for one in root.iterfind(f"{TAG}Aliases/{TAG}Alias")}

    def key(text: str | None) -> NodeKey:
        *space, number = aliases.get(text, str(text)).split(";")
        return uris[int(space[0].removeprefix("ns="))] if space else STANDARD, int(number.removeprefix("i="))

    def name(text: str) -> tuple[str, str]:
        index, _, rest = text.partition(":")
        return (uris[int(index)], rest) if index.isdigit() else (STANDARD, text)

    found = {}
    for one in root.iterchildren(tag=etree.Element):
        if one.get("NodeId") is not None:
            data_type = one.get("DataType")
            found[key(one.get("NodeId"))] = Described(
                str(one.tag).removeprefix(f"{TAG}UA"),
                name(one.get("BrowseName", "")),
                None if data_type is None else key(data_type),
                one.get("IsAbstract") == "true",
                frozenset(
                    (key(each.get("ReferenceType"))[1], each.get("IsForward") != "false", key(each.text))
                    for each in one.iterfind(f"{TAG}References/{TAG}Reference")
                ),
            )
    return found


async def ours() -> Mapping[NodeKey, Described]:
    """Return the nodes that our server has in the two namespaces."""
    server = Server()
    await server.init()
    spaces = await Namespaces.registered(server)
    await add_companion_types(server, spaces)
    uris = await server.get_namespace_array()
    uris[0] = STANDARD

    def key(node: ua.NodeId) -> NodeKey:
        return uris[node.NamespaceIndex], int(node.Identifier)

    found = {}
    for one in [one for one in list(server.iserver.aspace.keys()) if uris[one.NamespaceIndex] in FILES]:
        node = server.get_node(one)
        name, node_class = await node.read_browse_name(), await node.read_node_class()
        is_variable = node_class is ua.NodeClass.Variable
        is_type = node_class in (ua.NodeClass.ObjectType, ua.NodeClass.DataType)
        is_abstract = is_type and (await node.read_attribute(ua.AttributeIds.IsAbstract)).Value.Value
        references = frozenset(
            (int(each.ReferenceTypeId.Identifier), each.IsForward, key(each.NodeId))
            for each in await node.get_references()
            if isinstance(each.NodeId.Identifier, int)
        )
        found[key(one)] = Described(
            node_class.name,
            (uris[name.NamespaceIndex], name.Name),
            key(await node.read_data_type()) if is_variable else None,
            is_abstract,
            references,
        )
    return found


def differences(own: Mapping[NodeKey, Described], sets: Mapping[NodeKey, Described]) -> Iterator[str]:
    """Tell what our nodes have that the node sets do not have."""
    for node, described in own.items():
        other = sets.get(node)
        if other is None:
            yield f"{node}: {described.name} is in no node set"
            continue
        for what in ("node_class", "name", "data_type", "is_abstract"):
            if getattr(described, what) != getattr(other, what):
                yield f"{node}: {what} is {getattr(described, what)}, published {getattr(other, what)}"
        told = {(kind, to) for kind, is_forward, to in other.references if is_forward}
        for kind, is_forward, to in described.references:
            back = sets.get(to)
            is_published = (kind, to) in told or (
                back is not None and (kind, not is_forward, node) in back.references
            )
            if is_forward and not is_published:
                yield f"{node} {described.name}: reference {kind} to {to} is not published"


def main() -> None:
    """Print the differences; the status says whether there are any."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    sets: dict[NodeKey, Described] = {}
    for name in FILES.values():
        sets |= published(folder / name)
    own = asyncio.run(ours())
    found = list(differences(own, sets))
    print(f"{len(own)} nodes of ours beside {len(sets)} published: {len(found)} differences")
    for line in found:
        print(line)
    raise SystemExit(bool(found))


if __name__ == "__main__":
    main()
