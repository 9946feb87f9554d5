"""What an IED holds, told twice: by its SCL file, read here with nothing of ours, and by its MMS server.

Both sides speak of MMS names (IEC 61850-8-1): "LLN0$ST$Mod$stVal", with control blocks by name only.
"""

import ctypes
import socket
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import mms
from mms.binding.linked_lists import take_names
from mms.client.connection import Connection

NAMESPACE = "{http://www.iec.ch/61850/2003/SCL}"
BLOCKS = {"BR", "RP", "LG", "GO", "MS", "US"}
SETTINGS = "SGCB"


@dataclass
class Contents:
    """names: of every domain, its named variables; data_sets: members by "domain/LN.data set"."""

    names: dict[str, set[str]] = field(default_factory=dict)
    data_sets: dict[str, list[str]] = field(default_factory=dict)


# by the file


def contents_of_file(path: Path, ied_name: str) -> Contents:
    root = ET.parse(path).getroot()  # noqa: S314 (files of these tests and of their user)
    _into_namespace(root)
    (ied,) = (each for each in _all(root, "IED") if each.get("name") == ied_name)
    devices = list(ied.iter(f"{NAMESPACE}LDevice"))
    domains = {
        each.get("inst", ""): each.get("ldName") or f"{ied_name}{each.get('inst')}" for each in devices
    }
    types = _Types(root)
    contents = Contents()
    for device in devices:
        domain = domains[device.get("inst", "")]
        names = contents.names[domain] = set()
        for node in (*_all(device, "LN0"), *_all(device, "LN")):
            name = f"{node.get('prefix') or ''}{node.get('lnClass')}{node.get('inst') or ''}"
            paths = {*types.of_node(node), *_blocks(node)}
            names.add(name)
            for path_of_names in paths:
                names.update(
                    "$".join((name, *path_of_names[:depth])) for depth in range(1, len(path_of_names) + 1)
                )
            for data_set in _all(node, "DataSet"):
                contents.data_sets[f"{domain}/{name}.{data_set.get('name')}"] = [
                    _member(member, domains, domain) for member in _all(data_set, "FCDA")
                ]
    return contents


def _into_namespace(root: ET.Element) -> None:
    """Put the elements of a file with another spelling of the namespace, or with none, into it."""
    own = root.tag.removesuffix("SCL")
    if own == NAMESPACE:
        return
    for element in root.iter():
        if isinstance(element.tag, str) and element.tag.startswith(own):
            element.tag = NAMESPACE + element.tag[len(own) :]


def _all(element: ET.Element, tag: str) -> list[ET.Element]:
    return element.findall(NAMESPACE + tag)


def _members(definition: ET.Element | None, tag: str) -> list[ET.Element]:
    """The members of a type; a type that the file lacks has none."""
    return [] if definition is None else _all(definition, tag)


class _Types:
    def __init__(self, root: ET.Element) -> None:
        types = [each for section in _all(root, "DataTypeTemplates") for each in section]
        self._types = {(each.tag.removeprefix(NAMESPACE), each.get("id")): each for each in types}
        self._nodes = {
            (each.get("id"), each.get("lnClass")): each
            for each in types
            if each.tag == f"{NAMESPACE}LNodeType"
        }

    def of_node(self, node: ET.Element) -> Iterator[tuple[str, ...]]:
        """Constraint and names of every data attribute, and of every array, whose elements have no names."""
        type_id = node.get("lnType")
        definition = self._nodes.get((type_id, node.get("lnClass")), self._types.get(("LNodeType", type_id)))
        for member in _members(definition, "DO"):
            for constraint, path in self._of_object(member):
                yield (constraint, member.get("name", ""), *path)

    def _of_object(self, user: ET.Element) -> Iterator[tuple[str, tuple[str, ...]]]:
        definition = self._types.get(("DOType", user.get("type")))
        for part in _members(definition, "SDO"):
            for constraint, path in self._of_object(part):
                yield constraint, (part.get("name", ""), *(() if part.get("count") else path))
        for part in _members(definition, "DA"):
            constraint = part.get("fc", "")
            for path in self._of_attribute(part):
                yield constraint, path
                if constraint == "SE":
                    yield "SG", path

    def _of_attribute(self, attribute: ET.Element) -> Iterator[tuple[str, ...]]:
        name = attribute.get("name", "")
        if attribute.get("bType") != "Struct" or attribute.get("count"):
            yield (name,)
            return
        for part in _members(self._types.get(("DAType", attribute.get("type"))), "BDA"):
            for path in self._of_attribute(part):
                yield (name, *path)


def _blocks(node: ET.Element) -> Iterator[tuple[str, ...]]:
    for report in _all(node, "ReportControl"):
        enabled = report.find(f"{NAMESPACE}RptEnabled")
        most = 1 if enabled is None else int(enabled.get("max", "1"))
        numbers = (
            [f"{n:02d}" for n in range(1, most + 1)] if report.get("indexed", "true") == "true" else [""]
        )
        for number in numbers:
            yield ("BR" if report.get("buffered") == "true" else "RP"), f"{report.get('name')}{number}"
    for block in _all(node, "LogControl"):
        yield "LG", block.get("name", "")
    for block in _all(node, "GSEControl"):
        yield "GO", block.get("name", "")
    for block in _all(node, "SampledValueControl"):
        yield ("US" if block.get("multicast") == "false" else "MS"), block.get("name", "")
    if _all(node, "SettingControl"):
        yield "SP", SETTINGS


def _member(member: ET.Element, domains: dict[str, str], own: str) -> str:
    """As clients write it, "LD/LN.DO.DA[FC]"; an index stands behind the array, here always a sub object."""
    node = f"{member.get('prefix') or ''}{member.get('lnClass')}{member.get('lnInst') or ''}"
    index = f"({member.get('ix')})" if member.get("ix") else ""
    path = ".".join(filter(None, (f"{member.get('doName')}{index}", member.get("daName"))))
    return f"{domains.get(member.get('ldInst', ''), own)}/{node}.{path}[{member.get('fc')}]"


# by the server


@contextmanager
def served(text: str, updates: Mapping[str, mms.Value] | None = None) -> Iterator[mms.Client]:
    """A client of a server that serves a model text, with other values than it starts with."""
    with _serving(text, updates or {}) as port, mms.Client.connect("127.0.0.1", port) as client:
        yield client


def contents_of_server(text: str) -> Contents:
    """What a server of this model text lists: GetNameList and the data sets' directories."""
    with _serving(text, {}) as port:
        return contents_at("127.0.0.1", port)


def contents_at(host: str, port: int) -> Contents:
    """The same of a server that is there."""
    connection = Connection(host, port, connect_timeout_s=5, request_timeout_s=5)
    contents = Contents()
    with mms.Client(connection) as client:
        for domain in client.logical_devices():
            contents.names[domain] = {_to_block(name) for name in _variables(connection, domain)}
            for node in client.logical_nodes(domain):
                reference = f"{domain}/{node}"
                for name in client.data_sets(reference):
                    directory = client.data_set_directory(f"{reference}.{name}")
                    contents.data_sets[f"{reference}.{name}"] = list(directory)
    return contents


def _variables(connection: Connection, domain: str) -> list[str]:
    function = connection.lib.IedConnection_getLogicalDeviceVariables
    function.restype = ctypes.c_void_p
    function.argtypes = [ctypes.c_void_p, ctypes.POINTER(ctypes.c_int), ctypes.c_char_p]
    return take_names(
        connection.lib, connection.client_request(f"variables of {domain}", function, domain.encode())
    )


def _to_block(name: str) -> str:
    """The name without what stands below a control block."""
    parts = name.split("$")
    if len(parts) > 3 and (parts[1] in BLOCKS or parts[1:3] == ["SP", SETTINGS]):
        return "$".join(parts[:3])
    return name


@contextmanager
def _serving(text: str, updates: Mapping[str, mms.Value]) -> Iterator[int]:
    """The port of a server; another is tried when one is taken meanwhile."""
    for attempt in range(5):
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            port = int(listener.getsockname()[1])
        server = mms.Server(text, port=port)
        try:
            server.start()
        except mms.ServerStartFailed:
            server.close()
            if attempt == 4:
                raise
            continue
        break
    with server:
        server.update_many(updates)
        yield port
