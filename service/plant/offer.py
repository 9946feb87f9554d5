"""The names a relay offers to its clients, from its SCL or from the relay itself.

Both have the same form here, so that the same rules apply to both and they can be compared.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from scl.ied_model import Ied

_NODE_CLASS = re.compile(r"([A-Z]{4})\d*$")


@dataclass(frozen=True, slots=True)
class ReportBlock:
    """A report control block "LD/LLN0.BR.BRep01" (RP: unbuffered) and its data set "LD/LLN0.DSet01"."""

    reference: str
    data_set: str | None

    @property
    def buffered(self) -> bool:
        return self.reference.split(".")[1:2] == ["BR"]


@dataclass(frozen=True, slots=True)
class Offer:
    """The names that a relay offers.

    nodes: data objects of each logical node "LD/LN".  data_sets: members "LD/LN.DO.DA[FC]" of each data set
    "LD/LN.name".  report_blocks: in the order they are offered.
    """

    nodes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    data_sets: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    report_blocks: tuple[ReportBlock, ...] = ()

    @property
    def devices(self) -> tuple[str, ...]:
        """Return the logical devices (MMS domains)."""
        return tuple(dict.fromkeys(node.partition("/")[0] for node in self.nodes))

    def nodes_of(self, device: str) -> frozenset[str]:
        """Return the names of a logical device's nodes."""
        return frozenset(node.partition("/")[2] for node in self.nodes if node.startswith(f"{device}/"))

    def objects(self, ln_class: str, name: str) -> Iterator[str]:
        """Return the references of the data objects of a name in the nodes of a class ("RDRE")."""
        for node, names in self.nodes.items():
            if name in names and node_class(node.partition("/")[2]) == ln_class:
                yield f"{node}.{name}"

    def has(self, reference: str) -> bool:
        """Tell whether the data object that a reference lies in is offered."""
        node, _, path = reference.partition(".")
        return path.partition(".")[0] in self.nodes.get(node, ())

    def data_sets_covering(self, reference: str) -> Iterator[str]:
        """Return the data sets with a member that carries the referenced object, or part of it."""
        for data_set, members in self.data_sets.items():
            if any(_overlap(member.partition("[")[0], reference) for member in members):
                yield data_set


def node_class(name: str) -> str | None:
    """Return the class of a logical node by its name: the four capitals before its number; None without."""
    found = _NODE_CLASS.search(name)
    return None if found is None else found[1]


def offer_from_scl(ied: Ied) -> Offer:
    """Return what a relay offers according to its SCL."""
    return Offer(
        nodes={
            node.reference: tuple(data_object.name for data_object in node.data_objects)
            for node in ied.logical_nodes()
        },
        data_sets={
            data_set.reference: tuple(f"{member.reference}[{member.fc}]" for member in data_set.members)
            for data_set in ied.data_sets()
        },
        report_blocks=tuple(
            ReportBlock(reference, None if report.data_set is None else report.data_set.reference)
            for report in ied.report_controls()
            for reference in report.references
        ),
    )


def _overlap(one: str, other: str) -> bool:
    return f"{one}.".startswith(f"{other}.") or f"{other}.".startswith(f"{one}.")
