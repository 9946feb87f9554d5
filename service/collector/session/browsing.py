"""Browses a relay: reads from the relay itself what it offers, as far as the service needs to know.

It makes one request after the other: one listing of names for each logical device, then one request for each
logical device's data sets, for each data set and for each report control block.
"""

from collections.abc import Iterator
from itertools import islice

import structlog

from mms import (
    AccessDenied,
    Client,
    ControlModel,
    FunctionalConstraint,
    NotFound,
    ProtocolError,
    TemporarilyUnavailable,
)
from service.plant import Offer, ReportBlock

log = structlog.get_logger(__name__)

REFUSALS = (AccessDenied, NotFound, ProtocolError, TemporarilyUnavailable, ValueError)
"""Errors of one request while the link is fine. ValueError: a name that is none."""

MOST_DEVICES, MOST_NODES, MOST_DATA_SETS, MOST_BLOCKS = 64, 4000, 64, 128
"""Limits for one relay. Protection relays have fewer; a faulty one may list any number."""


def browse(client: Client, expected: Offer | None) -> Offer | None:
    """Return what the relay offers; None where it cannot be browsed. Raises MmsError (the link).

    expected: what its SCL promises. Data sets are looked for where the SCL has some, and in every LLN0.
    """
    try:
        devices = client.logical_devices()[:MOST_DEVICES]
    except REFUSALS as error:
        log.warning("the relay cannot be browsed", host=client.host, reason=str(error))
        return None
    nodes = dict(islice(_nodes(client, devices), MOST_NODES))
    if not nodes:
        return None
    promised = () if expected is None else expected.data_sets
    with_data_sets = {reference.rpartition(".")[0] for reference in promised}
    return Offer(
        nodes=nodes,
        data_sets=dict(
            islice(
                _data_sets(
                    client, [node for node in nodes if node.endswith("/LLN0") or node in with_data_sets]
                ),
                MOST_DATA_SETS,
            )
        ),
        report_blocks=tuple(islice(_report_blocks(client, nodes), MOST_BLOCKS)),
    )


def control_model(client: Client, reference: str) -> ControlModel | None:
    """Return the control model of a data object as the relay has it; None where it is no control.

    Raises MmsError (the link).
    """
    try:
        model = client.read(f"{reference}.ctlModel", FunctionalConstraint.CF)
    except REFUSALS:
        return None
    return ControlModel(model) if isinstance(model, int) and model in tuple(ControlModel) else None


def _nodes(client: Client, devices: list[str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    for device in devices:
        try:
            names = client.logical_nodes(device)
        except REFUSALS as error:
            log.warning("a logical device is passed over", host=client.host, reason=str(error)[:200])
            continue
        for name in names:
            node = f"{device}/{name}"
            try:
                yield node, tuple(client.data_objects(node))
            except REFUSALS as error:
                log.info("a logical node is passed over", host=client.host, reason=str(error)[:200])


def _data_sets(client: Client, nodes: list[str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    for node in nodes:
        try:
            names = client.data_sets(node)
        except REFUSALS:
            continue
        for name in names:
            reference = f"{node}.{name}"
            try:
                yield reference, client.data_set_directory(reference)
            except REFUSALS as error:
                log.info("a data set is passed over", host=client.host, reason=str(error)[:200])


def _report_blocks(client: Client, nodes: dict[str, tuple[str, ...]]) -> Iterator[ReportBlock]:
    for node in nodes:
        try:
            blocks = [("BR", name) for name in client.buffered_reports(node)]
            blocks += [("RP", name) for name in client.unbuffered_reports(node)]
        except REFUSALS:
            continue
        for kind, name in blocks:
            yield ReportBlock(f"{node}.{kind}.{name}", _data_set_of(client, f"{node}.{name}", kind))


def _data_set_of(client: Client, block: str, kind: str) -> str | None:
    """Return the data set of a report control block. Relays name it as MMS does: LD/LLN0$DSet01."""
    try:
        data_set = client.read(f"{block}.DatSet", FunctionalConstraint[kind])
    except REFUSALS:
        return None
    return data_set.replace("$", ".") if isinstance(data_set, str) and data_set else None
