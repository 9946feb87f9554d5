"""Finds out what a relay offers, by browsing it at each connection, and compares that with its SCL.

Browsing makes one request after the other: one listing of names for each logical device, then one request for
each logical device's data sets, for each data set and for each report control block. Differences from the SCL
are stored. A difference in what the service uses raises an alarm. None ends a connection.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from itertools import islice
from typing import TypeVar

import structlog

from mms import (
    AccessDenied,
    Client,
    ControlModel,
    FunctionalConstraint,
    NotFound,
    ProtocolError,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.collector.records.event_folder import ROOT
from service.collector.records.listing import RefusedFile
from service.collector.session.relay_alarms import RelayAlarms
from service.plant import (
    Acquisition,
    Difference,
    Offer,
    Relay,
    ReportBlock,
    acquisition_from_offer,
    acquisition_from_scl,
    differences,
)
from service.storage import Repository
from service.storage.records import RelayFindings
from service.storage.states import AlarmKind

log = structlog.get_logger(__name__)

_Names = TypeVar("_Names", list[str], tuple[str, ...])

NOT_BROWSED = "the relay does not tell what it offers: its SCL is taken at its word"

REFUSALS = (AccessDenied, NotFound, ProtocolError, ServiceFailed, TemporarilyUnavailable, ValueError)
"""These errors concern one request, and the link is fine. ValueError stands for a name that is none."""

PATIENCE_S = (0.1, 0.5)
"""Pauses after which a relay that is busy is asked again for a list of names."""

MOST_DEVICES, MOST_NODES, MOST_DATA_SETS, MOST_BLOCKS = 64, 4000, 64, 128
"""No more of one relay is browsed. Protection relays have fewer; a faulty one may list any number."""


class Discovery:
    """What is known of one relay. Used by that relay's session alone."""

    def __init__(self, relay: Relay, repository: Repository, alarms: RelayAlarms) -> None:
        self._relay = relay
        self._repository = repository
        self._alarms = alarms
        self._acquisition = acquisition_from_scl(relay)
        self._control_model: str | None = None
        self._differences: list[dict[str, object]] = []
        self._browsed_ns = 0
        self._saved: RelayFindings | None = None

    def discover(self, client: Client) -> Acquisition:
        """Browse the relay and return what is to be used of it.

        Raises MmsError (the link), SQLAlchemyError.
        """
        offer = browse(client, self._relay.expected)
        self._browsed_ns = time.time_ns()
        self._differences = []
        if offer is None:
            self._acquisition = acquisition_from_scl(self._relay)
        else:
            self._acquisition = acquisition_from_offer(
                self._relay, offer, lambda control: bool(_control_model(client, control))
            )
            if self._relay.expected is not None:
                self._differences = [
                    _difference_document(each) for each in differences(self._relay.expected, offer)
                ]
        trigger = self._acquisition.trigger
        model = None if trigger is None else _control_model(client, trigger)
        self._control_model = None if model is None else model.words
        self._raise_alarms()
        return self._acquisition

    def save(
        self,
        *,
        report_control: str | None,
        directory: str | None,
        remarks: Sequence[str],
        ignored: Sequence[RefusedFile],
        ignored_in_all: int,
    ) -> None:
        """Store what is used and what is ignored, if that has changed since it was stored.

        Raises SQLAlchemyError; the next call then stores it.
        """
        findings = RelayFindings(
            ied=self._relay.name,
            found_ns=self._browsed_ns,
            acquisition=self._acquisition_document(report_control, directory, remarks),
            differences=self._differences,
            ignored_files=[asdict(each) for each in ignored],
            ignored_in_all=ignored_in_all,
        )
        if findings != self._saved:
            self._repository.note_findings(findings)
            self._saved = findings

    def _acquisition_document(
        self, report_control: str | None, directory: str | None, remarks: Sequence[str]
    ) -> dict[str, object]:
        found = self._acquisition
        overrides = self._relay.overrides
        return {
            "asked": found.asked,
            "trigger": found.trigger,
            "trigger_action": None if found.trigger is None else str(found.trigger_action),
            "control_model": self._control_model,
            "record_made": found.record_made,
            "record_number": found.record_number,
            "records_told_by": _announced_by(report_control),
            "report_control": report_control,
            "events_directory": "/" if directory == ROOT else directory,
            "overridden": [name for name, value in asdict(overrides).items() if value is not None],
            "remarks": [
                *([] if found.asked else [NOT_BROWSED]),
                *remarks,
                *(each.reason for each in found.deviations),
            ],
        }

    def _raise_alarms(self) -> None:
        deviations = self._acquisition.deviations
        for each in deviations:
            self._alarms.raise_alarm(AlarmKind.RELAY_DIFFERS, each.subject, each.reason)
        self._alarms.keep(AlarmKind.RELAY_DIFFERS, {each.subject for each in deviations})
        if self._differences:
            log.info("the relay differs from its SCL", relay=self._relay.name, number=len(self._differences))


def _announced_by(report_control: str | None) -> str:
    if report_control is None:
        return "polling"
    return "buffered-report" if ".BR." in report_control else "unbuffered-report"


def _difference_document(difference: Difference) -> dict[str, object]:
    return {"kind": str(difference.kind), "expected": difference.expected, "found": difference.found}


def browse(client: Client, expected: Offer | None) -> Offer | None:
    """Return what the relay offers; None where it cannot be browsed. Raises MmsError (the link).

    expected: what its SCL promises. Data sets are looked for where the SCL has some, and in every LLN0.
    """
    try:
        devices = _patiently(client.logical_devices)[:MOST_DEVICES]
    except REFUSALS as error:
        log.warning("the relay cannot be browsed", host=client.host, reason=str(error))
        return None
    nodes = dict(islice(_nodes(client, devices, expected), MOST_NODES))
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


def _control_model(client: Client, reference: str) -> ControlModel | None:
    """Return the control model of a data object as the relay has it; None where it is no control.

    Raises MmsError (the link).
    """
    try:
        model = client.read(f"{reference}.ctlModel", FunctionalConstraint.CF)
    except REFUSALS:
        return None
    return ControlModel(model) if isinstance(model, int) and model in tuple(ControlModel) else None


def _nodes(
    client: Client, devices: list[str], expected: Offer | None
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the logical nodes with their data objects; those of the SCL for a device that is busy."""
    for device in devices:
        try:
            names = _patiently(client.logical_nodes, device)
        except (ServiceFailed, TemporarilyUnavailable) as error:
            log.warning(
                "a logical device does not tell its nodes: its SCL is taken at its word",
                host=client.host, device=device, reason=str(error)[:200],
            )  # fmt: skip
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


def _patiently(list_names: Callable[..., _Names], *arguments: str) -> _Names:
    """Return a list of names; ask again, after a pause, a relay that is busy."""
    for pause_s in PATIENCE_S:
        try:
            return list_names(*arguments)
        except TemporarilyUnavailable as error:
            log.info("busy, asked again", reason=str(error), pause_s=pause_s)
            time.sleep(pause_s)
    return list_names(*arguments)


def _data_sets(client: Client, nodes: list[str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    for node in nodes:
        try:
            names = _patiently(client.data_sets, node)
        except REFUSALS:
            continue
        for name in names:
            reference = f"{node}.{name}"
            try:
                yield reference, _patiently(client.data_set_directory, reference)
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
