"""A client of open62541 (the package o6) that finds machines by their types, in a process of its own.

It brings along the node sets of OPC 10000-100 and OPC 40001-1, and compares with them what it browses.
Arguments: the folder of the package, address. Prints one JSON document with what it saw.
"""

import json
import sys
from collections.abc import Iterator
from typing import Any

folder, address = sys.argv[1:3]
sys.path.insert(0, folder)

import o6  # noqa: E402 - found in that folder only
import o6.ns.di  # noqa: E402
import o6.ns.machinery  # noqa: E402

COMPANIONS = ("di", "machinery")
ROOTS = ("i=58", "i=17602", "i=29", "i=11715", "i=85")
"""Types of objects, interfaces, enumerations, what is said of namespaces, objects."""
HAS_ADD_IN = "i=17604"
ALL_FIELDS = 63


def below(client: Any, root: str, seen: dict[str, Any]) -> Iterator[Any]:
    """All that is below a node, each once."""
    for one in client.browse(root, resultMask=ALL_FIELDS):
        key = str(one.nodeId)
        if key not in seen:
            seen[key] = one
            yield one
            yield from below(client, key, seen)


def declared(namespace: str, number: int) -> tuple[str, int] | None:
    """Name and class of a node in the node set; None where there is none."""
    try:
        found = o6.ns[f"ns={namespace};i={number}"]
    except KeyError:
        return None
    if isinstance(found, type):
        return found.__name__, 64 if issubclass(found, int) else 8
    return str(found.browsename).rpartition(";")[2], int(found.nodeclass)


def main() -> None:
    """Compare the types, and find the machines."""
    client = o6.Client(address)
    client.connect(createDefaultSubscription=False)
    compared = 0
    others: list[object] = []
    machines: dict[str, dict[str, str]] = {}
    try:
        seen: dict[str, Any] = {}
        for root in ROOTS:
            for one in below(client, root, seen):
                space = one.nodeId.ns.shortname
                if space not in COMPANIONS:
                    continue
                has = (one.browseName.name, int(one.nodeClass))
                wanted = declared(space, int(one.nodeId.id))
                compared += 1
                if has != wanted:
                    others.append([space, int(one.nodeId.id), has, wanted])
        for machine in client.browse(f"ns={o6.ns.machinery.index};i=1001", resultMask=ALL_FIELDS):
            parts = client.browse(str(machine.nodeId), reftype=HAS_ADD_IN, resultMask=ALL_FIELDS)
            machines[machine.browseName.name] = {
                part.browseName.name: o6.ns[f"ns=machinery;i={part.typeDefinition.id}"].__name__
                for part in parts
            }
    finally:
        client.disconnect()
    seen_here = {"compared": compared, "others": others, "machines": machines}
    sys.stdout.write("\n" + json.dumps(seen_here, default=str) + "\n")


main()
