"""How many IEDs, devices, nodes, data sets and control blocks a file has: as read, and as lxml counts."""

from collections.abc import Iterable, Mapping
from itertools import chain
from pathlib import Path

from lxml import etree

from benchmarks.corpus.outcomes import Agreement, Comparison
from scl import Scl

_DEVICES = "/s:SCL/s:IED/s:AccessPoint/s:Server/s:LDevice"
_NODES = f"{_DEVICES}/*[self::s:LN0 or self::s:LN]"
XPATHS: Mapping[str, str] = {
    "IED": "/s:SCL/s:IED",
    "LDevice": _DEVICES,
    "LN": _NODES,
    "DataSet": f"{_NODES}/s:DataSet",
    "ReportControl": f"{_NODES}/s:ReportControl",
    "LogControl": f"{_NODES}/s:LogControl",
    "GSEControl": f"{_NODES}/s:GSEControl",
    "SampledValueControl": f"{_NODES}/s:SampledValueControl",
}


def compared(document: Scl, path: Path) -> Comparison:
    """Compare counts; what is missing is explained if the reader said that it leaves out just that."""
    ours = counts_as_read(document)
    elements = _elements(path)
    told = [finding for finding in document.warnings if finding.left_out]
    places = {(finding.line, finding.element.lstrip("<").split(" ")[0].rstrip(">")) for finding in told}
    notes, unexplained = [], False
    for kind, found in elements.items():
        if ours[kind] == len(found):
            continue
        least = sum(not _is_within(element, places) for element in found)
        explained = least <= ours[kind] <= len(found)
        unexplained = unexplained or not explained
        why = "warnings name what is left out" if explained else f"warnings leave {least}"
        notes.append(f"{kind}: {ours[kind]} read, {len(found)} in the file: {why}")
    if not notes:
        return Comparison(Agreement.AGREES)
    return Comparison(Agreement.DIFFERS if unexplained else Agreement.EXPLAINED, tuple(notes))


def counts_as_read(document: Scl) -> dict[str, int]:
    """The numbers of each kind in what the reader made of a file."""
    devices = [device for ied in document.ieds for device in ied.logical_devices]
    nodes = [node for device in devices for node in device.logical_nodes]
    return {
        "IED": len(document.ieds),
        "LDevice": len(devices),
        "LN": len(nodes),
        "DataSet": _sum(node.data_sets for node in nodes),
        "ReportControl": _sum(node.report_controls for node in nodes),
        "LogControl": _sum(node.log_controls for node in nodes),
        "GSEControl": _sum(node.goose_controls for node in nodes),
        "SampledValueControl": _sum(node.sampled_value_controls for node in nodes),
    }


def _sum(parts: Iterable[tuple[object, ...]]) -> int:
    return len(list(chain.from_iterable(parts)))


def _elements(path: Path) -> dict[str, list[etree._Element]]:
    """The elements of each kind. The namespace is that of the root, or none."""
    root = etree.parse(path, etree.XMLParser(resolve_entities=False, no_network=True)).getroot()
    namespace = etree.QName(root).namespace
    found = {}
    for kind, xpath in XPATHS.items():
        asked = root.xpath(
            xpath if namespace else xpath.replace("s:", ""),
            namespaces={"s": namespace} if namespace else None,
        )
        found[kind] = list(asked)
    return found


def _is_within(element: etree._Element, places: set[tuple[int, str]]) -> bool:
    """Whether an element, or one around it, is among the places (line and tag)."""
    around = chain([element], element.iterancestors(etree.Element))
    return any((each.sourceline or 0, etree.QName(each).localname) in places for each in around)
