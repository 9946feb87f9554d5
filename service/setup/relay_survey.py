"""Asks relays what they offer: reachable or not, name plate, trigger, reports, recordings, clock.

Nothing is operated and no recording is pulled.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from threading import Timer

from core.units import NANOSECONDS_PER_SECOND
from mms import Client, CredentialFileError, FunctionalConstraint, MmsError, Timestamp
from service.collector.records.event_folders import ROOT, EventFolders
from service.collector.records.listing import understand
from service.collector.session.browsing import REFUSALS, browse
from service.collector.session.clock_monitor import (
    FAST_PERIOD_S,
    clock_reading,
    stamp_of,
)
from service.collector.text_reports.text_reports import USUAL, list_reports
from service.configuration.relay_access import AccessError, credentials
from service.configuration.settings import Settings
from service.plant import Acquisition, Offer, Relay, acquisition_from_offer, acquisition_from_scl, differences
from service.plant.overrides import NONE
from service.process.logs import without_logs

AT_A_TIME = 8
"""So many relays are asked at a time. Each gets one request after the other."""

LONGEST_S = 60.0
"""A relay that takes longer is left alone."""

NAME_PLATE = ("vendor", "model", "serNum", "swRev")
"""These attributes of a name plate (IEC 61850-7-3, DPL) tell what a device is."""

LONGEST_TEXT = 60

MOST_STAMPS = 8
"""The stamps of so many measured values are read, until one changes."""


@dataclass(frozen=True, slots=True)
class RelaySurvey:
    """What one relay answered.

    unreachable: why it could not be asked; None where it could, and all else is empty otherwise.
    name_plate: vendor, model, serial number and software revision, as far as it tells them.
    offer: its names; None where it cannot be browsed.
    acquisition: what the service would use of it.
    differences: how many names differ from its SCL.
    folder: where its recordings are; None where none was found, for the reason `no_folder`.
    recordings: how many it lists.
    text_reports: names of the text reports that it lists and the service reads.
    clock_offset_s: how far its clock is ahead of ours; None where no measured value changed meanwhile.
    stamp_age_s: how old its latest time stamp is, where nothing else is known of its clock.
    """

    relay: Relay
    unreachable: str | None = None
    name_plate: Mapping[str, str] | None = None
    offer: Offer | None = None
    acquisition: Acquisition | None = None
    differences: int = 0
    folder: str | None = None
    no_folder: str | None = None
    recordings: int = 0
    text_reports: tuple[str, ...] = ()
    clock_offset_s: float | None = None
    stamp_age_s: float | None = None


def survey(
    relays: Sequence[Relay],
    settings: Settings,
    on_answer: Callable[[RelaySurvey], None] = lambda _: None,
    *,
    clock_s: float = 0.0,
) -> tuple[RelaySurvey, ...]:
    """Ask the relays and return what they answered, in their order.

    clock_s: the time for which each relay's clock is looked at; 0 for not at all.
    on_answer: is told of each relay as soon as it has answered.
    """
    found: dict[str, RelaySurvey] = {}
    with without_logs(), ThreadPoolExecutor(AT_A_TIME) as pool:
        futures = [pool.submit(survey_relay, relay, settings, clock_s) for relay in relays]
        for future in as_completed(futures):
            answer = future.result()
            found[answer.relay.name] = answer
            on_answer(answer)
    return tuple(found[relay.name] for relay in relays)


def survey_relay(relay: Relay, settings: Settings, clock_s: float = 0.0) -> RelaySurvey:
    """Ask one relay. Each connect and each request has the time limit of the settings."""
    try:
        own = credentials(settings.relays, relay.name)
        with Client.connect(
            relay.host,
            relay.port,
            connect_timeout_s=settings.connect_timeout_s,
            request_timeout_s=settings.request_timeout_s,
            tls=own.tls,
            password=own.spoken_password,
        ) as client:
            limit = Timer(LONGEST_S, client.abandon)
            limit.start()
            try:
                return _asked(relay, client, settings, clock_s)
            finally:
                limit.cancel()
    except (MmsError, CredentialFileError, AccessError) as error:
        return RelaySurvey(relay, unreachable=str(error))


def _asked(relay: Relay, client: Client, settings: Settings, clock_s: float) -> RelaySurvey:
    offer = browse(client, relay.expected)
    if offer is None:
        acquisition = acquisition_from_scl(relay)
    else:
        acquisition = acquisition_from_offer(relay, offer, lambda control: _is_control(client, control))
    folders = EventFolders(relay.name, settings.events_directory, relay.overrides.events_directory)
    contents = folders.contents(client)
    directory = contents.directory
    offset_s, age_s = _clock(client, acquisition, clock_s)
    records = understand(contents.folders).records
    return RelaySurvey(
        relay,
        name_plate={} if offer is None else _name_plate(client, offer),
        offer=offer,
        acquisition=acquisition,
        differences=0 if offer is None or relay.expected is None else len(differences(relay.expected, offer)),
        folder="/" if directory == ROOT else directory,
        no_folder=folders.missing,
        recordings=len(records),
        text_reports=_text_reports(client, relay),
        clock_offset_s=offset_s,
        stamp_age_s=age_s,
    )


def _text_reports(client: Client, relay: Relay) -> tuple[str, ...]:
    directory = relay.overrides.reports_directory or USUAL
    if directory == NONE:
        return ()
    return tuple(report.name for report in list_reports(client, directory).values())


def _is_control(client: Client, reference: str) -> bool:
    try:
        return isinstance(client.read(f"{reference}.ctlModel", FunctionalConstraint.CF), int)
    except REFUSALS:
        return False


def _name_plate(client: Client, offer: Offer) -> dict[str, str]:
    """Return the name plate of the physical device, or else that of a logical device."""
    plates = (*offer.objects("LPHD", "PhyNam"), *_of_lln0(offer))
    for plate in plates:
        found = dict(_plate_texts(client, plate))
        if found:
            return found
    return {}


def _of_lln0(offer: Offer) -> Iterator[str]:
    for node, names in offer.nodes.items():
        if node.endswith("/LLN0") and "NamPlt" in names:
            yield f"{node}.NamPlt"


def _plate_texts(client: Client, plate: str) -> Iterator[tuple[str, str]]:
    for name in NAME_PLATE:
        try:
            text = client.read(f"{plate}.{name}", FunctionalConstraint.DC)
        except REFUSALS:
            continue
        if isinstance(text, str) and text.strip():
            plain = "".join(each if each.isprintable() else "?" for each in text.strip())
            yield name, plain[:LONGEST_TEXT]


def _clock(client: Client, acquisition: Acquisition, longest_s: float) -> tuple[float | None, float | None]:
    """Return how far the clock is ahead [s], and how old its latest time stamp is [s]; None where not known.

    The clock is known where a measured value changes while the values are read.
    """
    stamps = [each.stamp for each in acquisition.measurands if not each.quantity.is_statistic][:MOST_STAMPS]
    before: dict[str, Timestamp] = {}
    latest_ns = 0
    asked_ns, until_s = time.time_ns(), time.monotonic() + longest_s
    while stamps and time.monotonic() < until_s:
        for reference in stamps:
            stamp = stamp_of(client, reference, FunctionalConstraint.MX)
            answered_ns = time.time_ns()
            if stamp is None:
                continue
            latest_ns = max(latest_ns, stamp.ns)
            if before.setdefault(reference, stamp) != stamp:
                reading = clock_reading(stamp, asked_ns=asked_ns, answered_ns=answered_ns)
                return reading.offset_ns / NANOSECONDS_PER_SECOND, None
        asked_ns = time.time_ns()
        time.sleep(FAST_PERIOD_S)
    return None, (time.time_ns() - latest_ns) / NANOSECONDS_PER_SECOND if latest_ns else None
