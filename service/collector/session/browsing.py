"""Browses a relay: asks it for its logical devices, nodes, data sets and report control blocks.

It makes one request after the other: two lists of names for each logical device, then one request for each
data set and for each report control block. What a busy relay does not tell is taken from its SCL.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from typing import TypeVar

import structlog

from mms import (
    AccessDenied,
    Client,
    FunctionalConstraint,
    NotFound,
    ProtocolError,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.plant import Offer, ReportBlock

log = structlog.get_logger(__name__)

_Answer = TypeVar("_Answer")

REFUSALS = (AccessDenied, NotFound, ProtocolError, ServiceFailed, TemporarilyUnavailable, ValueError)
"""These errors concern one request, and the link is fine. ValueError stands for a name that is none."""

PATIENCE_S = (0.1, 0.5)
"""Pauses after which a relay that is busy is asked again."""

LONGEST_PATIENCE_S = 3.0
"""All pauses of one browse together are no longer, so that a stop of the service does not wait for them."""

BUSY = (ServiceFailed, TemporarilyUnavailable)
"""By these errors the relay says that it cannot serve the request; what it has is not known then."""

MOST_DEVICES, MOST_NODES, MOST_DATA_SETS, MOST_BLOCKS = 64, 4000, 64, 128
"""No more of one relay is browsed. Protection relays have fewer; a faulty one may list any number."""


class _Patience:
    """Asks a relay that is busy again, after a pause, as long as the pauses of a whole browse are short."""

    def __init__(self) -> None:
        self._left_s = LONGEST_PATIENCE_S

    def ask(self, request: Callable[..., _Answer], *arguments: object) -> _Answer:
        """Return the answer to a request."""
        for pause_s in PATIENCE_S:
            try:
                return request(*arguments)
            except TemporarilyUnavailable as error:
                if self._left_s < pause_s:
                    raise
                self._left_s -= pause_s
                log.info("busy, asked again", reason=str(error), pause_s=pause_s)
                time.sleep(pause_s)
        return request(*arguments)


def browse(client: Client, expected: Offer | None) -> Offer | None:
    """Return what the relay offers; None where it cannot be browsed. Raises MmsError (the link).

    expected: what its SCL promises. Data sets are looked for where the SCL has some, and in every LLN0.
    """
    patience = _Patience()
    try:
        devices = patience.ask(client.logical_devices)[:MOST_DEVICES]
    except REFUSALS as error:
        log.warning("the relay cannot be browsed", host=client.host, reason=str(error))
        return None
    nodes = dict(islice(_nodes(client, devices, expected, patience), MOST_NODES))
    if not nodes:
        return None
    promised = {} if expected is None else expected.data_sets
    owners = {reference.rpartition(".")[0] for reference in promised}
    with_data_sets = [node for node in nodes if node.endswith("/LLN0") or node in owners]
    blocks = {} if expected is None else {block.reference: block for block in expected.report_blocks}
    return Offer(
        nodes=nodes,
        data_sets=dict(islice(_data_sets(client, with_data_sets, promised, patience), MOST_DATA_SETS)),
        report_blocks=tuple(islice(_report_blocks(client, nodes, blocks, patience), MOST_BLOCKS)),
    )


def _nodes(
    client: Client, devices: list[str], expected: Offer | None, patience: _Patience
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the logical nodes with their data objects; those of the SCL for a device that is busy."""
    for device in devices:
        try:
            names = patience.ask(client.logical_nodes, device)
        except BUSY as error:
            _log_promised(client, device, error)
            promised = {} if expected is None else expected.nodes
            yield from ((node, what) for node, what in promised.items() if node.startswith(f"{device}/"))
            continue
        except REFUSALS as error:
            log.warning("a logical device is passed over", host=client.host, reason=str(error)[:200])
            continue
        for name in names:
            node = f"{device}/{name}"
            try:
                yield node, tuple(client.data_objects(node))
            except REFUSALS as error:
                log.info("a logical node is passed over", host=client.host, reason=str(error)[:200])


def _data_sets(
    client: Client, nodes: list[str], promised: Mapping[str, tuple[str, ...]], patience: _Patience
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the data sets with their members; those of the SCL where the relay is busy."""
    for node in nodes:
        try:
            references = [f"{node}.{name}" for name in patience.ask(client.data_sets, node)]
        except BUSY as error:
            _log_promised(client, node, error)
            references = [reference for reference in promised if reference.startswith(f"{node}.")]
        except REFUSALS:
            continue
        for reference in references:
            try:
                yield reference, patience.ask(client.data_set_directory, reference)
            except BUSY as error:
                _log_promised(client, reference, error)
                if reference in promised:
                    yield reference, promised[reference]
            except REFUSALS as error:
                log.info("a data set is passed over", host=client.host, reason=str(error)[:200])


def _report_blocks(
    client: Client,
    nodes: dict[str, tuple[str, ...]],
    promised: Mapping[str, ReportBlock],
    patience: _Patience,
) -> Iterator[ReportBlock]:
    """Yield the report control blocks with their data sets; as the SCL has them where the relay is busy."""
    for node in nodes:
        try:
            blocks = [("BR", name) for name in patience.ask(client.buffered_reports, node)]
            blocks += [("RP", name) for name in patience.ask(client.unbuffered_reports, node)]
        except BUSY as error:
            _log_promised(client, node, error)
            yield from (block for name, block in promised.items() if name.startswith(f"{node}."))
            continue
        except REFUSALS:
            continue
        for kind, name in blocks:
            reference = f"{node}.{kind}.{name}"
            try:
                yield ReportBlock(reference, _data_set_of(client, f"{node}.{name}", kind, patience))
            except BUSY as error:
                _log_promised(client, reference, error)
                yield promised.get(reference, ReportBlock(reference, None))


def _data_set_of(client: Client, block: str, kind: str, patience: _Patience) -> str | None:
    """Return the data set of a report control block. Relays name it as MMS does: LD/LLN0$DSet01."""
    try:
        data_set = patience.ask(client.read, f"{block}.DatSet", FunctionalConstraint[kind])
    except BUSY:
        raise
    except REFUSALS:
        return None
    return data_set.replace("$", ".") if isinstance(data_set, str) and data_set else None


def _log_promised(client: Client, what: str, error: Exception) -> None:
    log.warning("busy: its SCL is taken at its word", host=client.host, what=what, reason=str(error)[:200])
