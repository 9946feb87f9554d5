"""Data sets of a logical node: their FCDA elements as references (IEC 61850-6 clause 9.3.7)."""

import re
from functools import lru_cache

from lxml import etree

from scl.attribute_values import decimal
from scl.control_block_model import DataSet, DataSetMember
from scl.data_model import FunctionalConstraint
from scl.document import NAME, Document
from scl.ied_model import Ied

LONGEST_REFERENCE = 129
_CONSTRAINTS = dict(FunctionalConstraint.__members__)
ARRAY_INDEX = re.compile(r"\(([0-9]{1,6})\)")


class DataSetReader:
    """Reads the data sets of one IED.

    Parameters
    ----------
    document : Document
        The document.
    domains : dict of str to str
        MMS domain by inst of the logical device.
    """

    def __init__(self, document: Document, domains: dict[str, str]) -> None:
        self._document = document
        self._domains = domains
        self._members: list[tuple[etree._Element, DataSetMember]] = []

    def data_sets(self, elements: list[etree._Element], reference: str, device: str) -> dict[str, DataSet]:
        """Read the data sets of a logical node; those no client could name are left out.

        Parameters
        ----------
        elements : list of lxml.etree._Element
            DataSet elements.
        reference : str
            Reference of the logical node.
        device : str
            The inst of its logical device.

        Returns
        -------
        dict of str to DataSet
            The data sets by name.
        """
        document = self._document
        data_sets: dict[str, DataSet] = {}
        for element in elements:
            name = document.usable_name(element, "name")
            if name is None:
                continue
            if name in data_sets:
                document.leave_out(element, "a second data set of this name, the first one counts")
                continue
            members = [self._member(child, device) for child in document.children(element, "FCDA")]
            data_sets[name] = DataSet(
                name, f"{reference}.{name}", tuple(member for member in members if member is not None)
            )
        return data_sets

    def check(self, ied: Ied) -> None:
        """Note members that name no data of the IED. Call it once all of the IED has been read.

        Parameters
        ----------
        ied : Ied
            The IED.
        """
        nodes = {
            (device.inst, node.name): node for device in ied.logical_devices for node in device.logical_nodes
        }
        for element, member in self._members:
            node = nodes.get((member.logical_device, member.logical_node))
            if node is None or not node.offers(member):
                self._document.note(element, f"the data model has no {member.reference} [{member.fc}]")

    def _inst(self, element: etree._Element) -> str:
        """Return the inst of a member's logical device. Some files write the name of the domain."""
        named = element.get("ldInst", "")
        if named in self._domains:
            return named
        found = next((inst for inst, domain in self._domains.items() if domain == named), None)
        if found is None:
            return named
        self._document.note(element, f"ldInst={named!r} is the name of a domain: taken as {found!r}")
        return found

    def _member(self, element: etree._Element, device: str) -> DataSetMember | None:
        document = self._document
        inst = self._inst(element) or device
        constraint = element.get("fc", "")
        if inst not in self._domains:
            document.leave_out(element, f"no LDevice {inst!r} in this IED")
            return None
        fc = _CONSTRAINTS.get(constraint)
        if fc is None or not element.get("doName"):
            document.leave_out(element, "names no data without doName and a known fc")
            return None
        if not element.get("lnClass"):
            document.leave_out(element, "names no logical node without lnClass")
            return None
        logical_node = _logical_node(
            element.get("prefix", ""), element.get("lnClass", ""), element.get("lnInst", "")
        )
        if logical_node is None:
            document.leave_out(element, "names no logical node")
            return None
        path, index_text = _path(element.get("doName", ""), element.get("daName", ""), element.get("ix", ""))
        index = decimal(index_text) if index_text else None
        if index is None and index_text:
            document.note(element, f"ix={index_text!r} is no number: left out")
        reference = f"{self._domains[inst]}/{logical_node}.{path}"
        if len(reference) > LONGEST_REFERENCE:
            document.leave_out(element, f"a reference of over {LONGEST_REFERENCE} characters")
            return None
        member = DataSetMember(
            reference=reference,
            fc=fc,
            logical_device=inst,
            logical_node=logical_node,
            path=path,
            index=index,
        )
        self._members.append((element, member))
        return member


# Relays of one make repeat the same members thousands of times.
@lru_cache(maxsize=8192)
def _logical_node(prefix: str, ln_class: str, inst: str) -> str | None:
    """Return the node's name, None where a part of it is no name."""
    return (
        prefix + ln_class + inst
        if all(NAME.fullmatch(word or "x") for word in (prefix, ln_class, inst))
        else None
    )


@lru_cache(maxsize=8192)
def _path(do_name: str, da_name: str, ix: str) -> tuple[str, str]:
    """Return the path below the node without array index, and the index as it is written.

    Edition 1 writes it into the name, "phsAHar(2)"; edition 2 has the attribute ix.
    """
    indexed_path = ".".join(filter(None, (do_name, da_name)))
    indices = ARRAY_INDEX.findall(indexed_path) or [ix]
    return ARRAY_INDEX.sub("", indexed_path), indices[0]
