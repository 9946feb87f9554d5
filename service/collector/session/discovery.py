"""Finds out what a relay offers, by browsing it at each connection, and compares that with its SCL.

Differences from the SCL are stored. A difference in what the service uses raises an alarm. None ends a
connection.
"""

import time
from collections.abc import Sequence
from dataclasses import asdict

import structlog

from mms import (
    Client,
    ControlModel,
    FunctionalConstraint,
)
from service.collector.records.event_folders import ROOT
from service.collector.records.listing import RefusedFile
from service.collector.session.browsing import BUSY, REFUSALS, browse
from service.collector.session.notes import Notes
from service.collector.session.relay_alarms import RelayAlarms
from service.plant import (
    Acquisition,
    Difference,
    Relay,
    acquisition_from_offer,
    acquisition_from_scl,
    differences,
)
from service.storage.records import RelayFindings
from service.storage.states import AlarmKind

log = structlog.get_logger(__name__)

NOT_BROWSED = "the relay does not tell what it offers: its SCL is taken at its word"


class Discovery:
    """What is known of one relay. Used by that relay's session alone."""

    def __init__(self, relay: Relay, alarms: RelayAlarms, notes: Notes) -> None:
        """Know nothing of the relay yet.

        notes: takes what is found.
        """
        self._relay = relay
        self._notes = notes
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
                self._relay, offer, lambda control: _may_be_control(client, control)
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
        text_reports: Sequence[str],
        ignored: Sequence[RefusedFile],
        ignored_in_all: int,
    ) -> None:
        """Store what is used and what is ignored, if that has changed since it was stored.

        Raises SQLAlchemyError where it is stored at once; the next call then stores it.
        """
        findings = RelayFindings(
            ied=self._relay.name,
            found_ns=self._browsed_ns,
            acquisition=self._acquisition_document(report_control, directory, remarks, text_reports),
            differences=self._differences,
            ignored_files=[asdict(each) for each in ignored],
            ignored_in_all=ignored_in_all,
        )
        if findings != self._saved:
            self._notes.add_findings(findings)
            self._saved = findings

    def _acquisition_document(
        self,
        report_control: str | None,
        directory: str | None,
        remarks: Sequence[str],
        text_reports: Sequence[str],
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
            "text_reports": list(text_reports),
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


def _control_model(client: Client, reference: str) -> ControlModel | None:
    """Return the control model of a data object; None where it is no control, or the relay is busy.

    Raises MmsError (the link).
    """
    try:
        return _read_control_model(client, reference)
    except BUSY:
        return None


def _may_be_control(client: Client, reference: str) -> bool:
    """Return whether a data object is a control, or the relay is too busy to say. Raises MmsError."""
    try:
        return _read_control_model(client, reference) is not None
    except BUSY:
        return True


def _read_control_model(client: Client, reference: str) -> ControlModel | None:
    try:
        model = client.read(f"{reference}.ctlModel", FunctionalConstraint.CF)
    except BUSY:
        raise
    except REFUSALS:
        return None
    return ControlModel(model) if isinstance(model, int) and model in tuple(ControlModel) else None
