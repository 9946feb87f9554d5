"""Points of a relay as its own model has them.

A profile names the points of its kind of relay. A point that a relay's model lacks is looked for under the
names that IEC 61850-7-4 and the SEL-700 family give it. So a relay of any make can be served.
"""

from collections.abc import Mapping
from typing import Final

from ied_sim.profiles.profile import Points
from scl.data_model import DataAttribute, DataObject, FunctionalConstraint
from scl.ied_model import Ied
from scl.logical_node import LogicalNode

_STANDARD_NAMES: Final[Mapping[str, tuple[tuple[str, str], ...]]] = {
    "trigger": (("RBGGIO1", "SPCSO01"), ("RDRE", "RcdTrg")),
    "pulse": (("PRBGGIO1", "SPCSO01"), ("RDRE", "RcdTrg")),
    "start": (("RBGGIO1", "SPCSO03"),),
    "stop": (("RBGGIO1", "SPCSO04"),),
    "clear": (("RDRE", "MemClr"),),
    "record_made": (("RDRE", "RcdMade"),),
    "record_number": (("RDRE", "FltNum"),),
    "record_started": (("RDRE", "RcdStr"),),
    "trip": (("PTRC", "Tr"),),
    "overcurrent": (("PIOC", "Op"),),
    "thermal": (("PTTR", "Op"),),
    "unbalance": (),
    "metering": (("MMXU", "A"),),
    "sequence": (("MSQI", "SeqA"),),
}
"""By key of `Points`: name or class of the logical node, and the data object."""

_BESIDE: Final[Mapping[str, tuple[str, ...]]] = {
    "metering": ("PhV", "PPV", "Hz", "TotW"),
    "sequence": ("SeqV",),
}
"""Data objects beside: of several nodes that one is taken that has most of them."""

_CONTROLS: Final = frozenset({"trigger", "pulse", "start", "stop", "clear"})
_NODES: Final = frozenset({"pulse", "metering", "sequence"})
"""Keys whose points are whole logical nodes."""


def fitted_points(ied: Ied, points: Points) -> dict[str, object]:
    """Return what a model has in place of the points that it lacks, by key; nothing if it has all of them.

    The value of a key is None, or an empty tuple, where the model has nothing of a standard name either.
    """
    nodes = _nodes(ied)
    fitted: dict[str, object] = {}
    for key in _STANDARD_NAMES:
        given = getattr(points, key)
        wanted = given if isinstance(given, tuple) else () if given is None else (given,)
        held = tuple(reference for reference in wanted if _holds(nodes, key, reference))
        if held != wanted:
            found = held or _candidates(nodes, key)[:1]
            fitted[key] = found if isinstance(given, tuple) else next(iter(found), None)
    if points.reports is not None and points.reports not in _buffered_reports(ied, None):
        told = fitted.get("record_made", points.record_made) or fitted.get("trip", points.trip)
        reports = [] if told is None else _buffered_reports(ied, str(told))
        fitted["reports"] = next(iter(reports), None)
    return fitted


def is_operable(found: DataObject | DataAttribute | None) -> bool:
    """Tell whether clients can operate a data object by true and false: it has Oper.ctlVal and ctlModel."""
    if not isinstance(found, DataObject):
        return False
    value, model = found.find("Oper.ctlVal"), found.find("ctlModel")
    return (
        isinstance(value, DataAttribute)
        and value.basic_type == "BOOLEAN"
        and isinstance(model, DataAttribute)
        and model.basic_type == "Enum"
        and model.fc is FunctionalConstraint.CF
        and value.fc is FunctionalConstraint.CO
    )


def _nodes(ied: Ied) -> dict[str, LogicalNode]:
    """Return the nodes by reference with the device's inst; recorders that tell of no record come last."""
    nodes = [
        (f"{device.inst}/{node.name}", node)
        for device in ied.logical_devices
        for node in device.logical_nodes
    ]
    nodes.sort(key=lambda each: each[1].ln_class == "RDRE" and each[1].find("RcdMade") is None)
    return dict(nodes)


def _holds(nodes: Mapping[str, LogicalNode], key: str, reference: str) -> bool:
    """Tell whether a model has a point that the profile names."""
    place, _, path = reference.partition(".")
    if place not in nodes or key in _NODES:
        return place in nodes
    return _serves(key, nodes[place].find(path))


def _serves(key: str, found: DataObject | DataAttribute | None) -> bool:
    return is_operable(found) if key in _CONTROLS else isinstance(found, DataObject)


def _candidates(nodes: Mapping[str, LogicalNode], key: str) -> tuple[str, ...]:
    """Return what a model has under the standard names of a point, the best first."""
    found = [
        (place, data_object)
        for name, data_object in _STANDARD_NAMES[key]
        for place, node in nodes.items()
        if name in (node.name, node.ln_class) and _serves(key, node.find(data_object))
    ]
    beside = _BESIDE.get(key, ())
    found.sort(key=lambda each: sum(nodes[each[0]].find(name) is None for name in beside))
    return tuple(place if key in _NODES else f"{place}.{data_object}" for place, data_object in found)


def _buffered_reports(ied: Ied, told: str | None) -> list[str]:
    """Return buffered report blocks, with the inst of their device: those that tell of a point, or all."""
    insts = {device.name: device.inst for device in ied.logical_devices}
    domains = {inst: name for name, inst in insts.items()}
    covering = None
    if told is not None:
        inst, _, rest = told.partition("/")
        covering = f"{domains.get(inst, inst)}/{rest}"
    return [
        f"{insts[domain]}/{path}"
        for report in ied.report_controls(buffered=True, covering=covering)
        for domain, _, path in (reference.partition("/") for reference in report.references)
    ]
