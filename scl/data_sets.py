"""Data sets of a logical node: their FCDA elements as references (IEC 61850-6 clause 9.3.7)."""

import re

from lxml import etree

from scl.data_model import DataSet, DataSetMember, FunctionalConstraint, Ied
from scl.document import NAME, Document, decimal, node_name

LONGEST_REFERENCE = 129
ARRAY_INDEX = re.compile(r"\(([0-9]{1,6})\)")


class DataSetReader:
    """Reads the data sets of one IED. domains: MMS domain by logical device inst."""

    def __init__(self, document: Document, domains: dict[str, str]) -> None:
        self._document = document
        self._domains = domains
        self._members: list[tuple[etree._Element, DataSetMember]] = []

    def data_sets(self, elements: list[etree._Element], reference: str, device: str) -> dict[str, DataSet]:
        """The data sets of a logical node of a device, by name; those no client could name are left out."""
        document = self._document
        data_sets: dict[str, DataSet] = {}
        for element in elements:
            name = document.usable_name(element, "name")
            if name is None:
                continue
            if name in data_sets:
                document.note(element, "a second data set of this name: the first one counts")
                continue
            members = [self._member(child, device) for child in document.children(element, "FCDA")]
            data_sets[name] = DataSet(
                name, f"{reference}.{name}", tuple(member for member in members if member is not None)
            )
        return data_sets

    def check(self, ied: Ied) -> None:
        """Findings for members that name no data of the IED, once all of it has been read."""
        for element, member in self._members:
            if ied.resolve(member) is None:
                self._document.note(element, f"the data model has no {member.reference} [{member.fc}]")

    def _member(self, element: etree._Element, device: str) -> DataSetMember | None:
        document = self._document
        inst = element.get("ldInst") or device
        constraint = element.get("fc", "")
        if inst not in self._domains:
            document.note(element, f"no LDevice {inst!r} in this IED: member left out")
            return None
        if constraint not in FunctionalConstraint.__members__ or not element.get("doName"):
            document.note(element, "names no data without doName and a known fc: member left out")
            return None
        if not all(NAME.fullmatch(element.get(word) or "x") for word in ("prefix", "lnClass", "lnInst")):
            document.note(element, "names no logical node: member left out")
            return None
        logical_node = "".join(node_name(document, element, "lnInst"))
        indexed_path = ".".join(filter(None, (element.get("doName"), element.get("daName"))))
        # edition 1 writes an array index into the name, "phsAHar(2)"; edition 2 has the attribute ix
        indices = ARRAY_INDEX.findall(indexed_path) or [element.get("ix", "")]
        index = decimal(indices[0])
        if index is None and indices[0]:
            document.note(element, f"ix={indices[0]!r} is no number: left out")
        path = ARRAY_INDEX.sub("", indexed_path)
        reference = f"{self._domains[inst]}/{logical_node}.{path}"
        if len(reference) > LONGEST_REFERENCE:
            document.note(element, f"a reference of over {LONGEST_REFERENCE} characters: member left out")
            return None
        member = DataSetMember(
            reference=reference,
            fc=FunctionalConstraint[constraint],
            logical_device=inst,
            logical_node=logical_node,
            path=path,
            index=index,
        )
        self._members.append((element, member))
        return member
