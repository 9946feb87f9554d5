"""Where a relay differs from its SCL: names that are missing, unexpected or changed."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import islice

from service.plant.offer import Offer, ReportBlock, node_class

MOST_DIFFERENCES = 200
"""So many are enough to see that a relay is of quite another kind."""

LONGEST = 300


class DifferenceKind(StrEnum):
    """What differs."""

    LOGICAL_DEVICE = "logical-device"
    LOGICAL_NODE = "logical-node"
    DATA_OBJECT = "data-object"
    DATA_SET = "data-set"
    REPORT_CONTROL = "report-control"


@dataclass(frozen=True, slots=True)
class Difference:
    """One difference.

    expected: what the SCL says; None where it has no such thing.
    found: what the relay offers; None where it lacks it.
    """

    kind: DifferenceKind
    expected: str | None
    found: str | None


def differences(expected: Offer, found: Offer) -> tuple[Difference, ...]:
    """Return at most MOST_DIFFERENCES. A renamed logical device counts once, with all that is in it."""
    return tuple(islice(_differences(expected, found), MOST_DIFFERENCES))


def _differences(expected: Offer, found: Offer) -> Iterator[Difference]:
    names = _namesakes(expected, found)
    for device in expected.devices:
        if names.get(device) != device:
            yield Difference(DifferenceKind.LOGICAL_DEVICE, device, names.get(device))
    for device in found.devices:
        if device not in names.values():
            yield Difference(DifferenceKind.LOGICAL_DEVICE, None, device)
    here = _renamed(expected, names)
    new = set(found.devices) - set(names.values())
    yield from _missing_and_extra(
        DifferenceKind.LOGICAL_NODE, _outside(here.nodes, set()), _outside(found.nodes, new)
    )
    for node in here.nodes:
        if node in found.nodes and node_class(node.partition("/")[2]) == "RDRE":
            yield from _missing_and_extra(
                DifferenceKind.DATA_OBJECT,
                {f"{node}.{name}": () for name in here.nodes[node]},
                {f"{node}.{name}": () for name in found.nodes[node]},
            )
    yield from _missing_and_extra(DifferenceKind.DATA_SET, here.data_sets, _outside(found.data_sets, new))
    yield from _missing_and_extra(
        DifferenceKind.REPORT_CONTROL,
        _blocks(here.report_blocks),
        _outside(_blocks(found.report_blocks), new),
    )


def _namesakes(expected: Offer, found: Offer) -> dict[str, str]:
    """Return the relay's name of each logical device of the SCL, without devices that the relay lacks.

    Devices are matched by name, then by the end of the name (its inst), then by their logical nodes.
    """
    names = {device: device for device in expected.devices if device in found.devices}
    unmatched = [device for device in found.devices if device not in names]
    for device in expected.devices:
        if device in names:
            continue
        alike = [other for other in unmatched if found.nodes_of(other) == expected.nodes_of(device)]
        ending = [other for other in unmatched if _common_ending(device, other)]
        candidates = [other for other in alike if other in ending] or alike or ending
        if candidates:
            names[device] = max(candidates, key=lambda other: _common_ending(device, other))
            unmatched.remove(names[device])
    return names


def _common_ending(one: str, other: str) -> int:
    """Return the length of the common end of two names; 0 below three, since every inst is longer."""
    length = 0
    while length < min(len(one), len(other)) and one[-1 - length] == other[-1 - length]:
        length += 1
    return length if length > 2 else 0


def _renamed(offer: Offer, names: Mapping[str, str]) -> Offer:
    """Return the offer of the SCL with the relay's own names, without the devices that the relay lacks."""

    def named(reference: str) -> str:
        device, slash, rest = reference.partition("/")
        return f"{names.get(device, device)}{slash}{rest}"

    kept = tuple(f"{device}/" for device in names)
    return replace(
        offer,
        nodes={named(node): objects for node, objects in offer.nodes.items() if node.startswith(kept)},
        data_sets={
            named(data_set): tuple(named(member) for member in members)
            for data_set, members in offer.data_sets.items()
            if data_set.startswith(kept)
        },
        report_blocks=tuple(
            ReportBlock(named(block.reference), block.data_set and named(block.data_set))
            for block in offer.report_blocks
            if block.reference.startswith(kept)
        ),
    )


def _outside(references: Mapping[str, tuple[str, ...]], devices: set[str]) -> dict[str, tuple[str, ...]]:
    return {name: what for name, what in references.items() if name.partition("/")[0] not in devices}


def _blocks(blocks: tuple[ReportBlock, ...]) -> dict[str, tuple[str, ...]]:
    return {block.reference: () if block.data_set is None else (block.data_set,) for block in blocks}


def _missing_and_extra(
    kind: DifferenceKind, expected: Mapping[str, tuple[str, ...]], found: Mapping[str, tuple[str, ...]]
) -> Iterator[Difference]:
    compared = kind in (DifferenceKind.DATA_SET, DifferenceKind.REPORT_CONTROL)
    for name, content in expected.items():
        if name not in found:
            yield Difference(kind, name, None)
        elif compared and content != found[name]:
            yield Difference(kind, _with(name, content), _with(name, found[name]))
    for name in found:
        if name not in expected:
            yield Difference(kind, None, name)


def _with(name: str, content: tuple[str, ...]) -> str:
    words = f"{name}: {', '.join(content) or 'nothing'}"
    return words if len(words) <= LONGEST else f"{words[:LONGEST]}..."
