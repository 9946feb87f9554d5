"""Asks relays what they offer: reachable or not, name plate, trigger, reports, recordings, clock.

Nothing is operated and no recording is pulled.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from threading import Timer

from core.units import NANOSECONDS_PER_SECOND
from mms import Client, CredentialFileError, FunctionalConstraint, MmsError
from service.collector.records.event_folder import ROOT, EventFolder
from service.collector.records.listing import understand
from service.collector.session.browsing import REFUSALS, browse
from service.collector.session.clock_monitor import (
    FAST_PERIOD_S,
    FAST_READING_S,
    clock_reading,
    stamp_of,
)
from service.configuration.relay_access import AccessError, credentials
from service.configuration.settings import Settings
from service.plant import Acquisition, Offer, Relay, acquisition_from_offer, acquisition_from_scl, differences
from service.process.logs import without_logs

AT_A_TIME = 8
"""So many relays are asked at a time. Each gets one request after the other."""

LONGEST_S = 60.0
"""A relay that takes longer is left alone."""

NAME_PLATE = ("vendor", "model", "serNum", "swRev")
"""These attributes of a name plate (IEC 61850-7-3, DPL) tell what a device is."""

LONGEST_TEXT = 60


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
    clock_offset_s: how far its clock is ahead of ours; None where it does not tell.
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
    clock_offset_s: float | None = None


def survey(
    relays: Sequence[Relay], settings: Settings, on_answer: Callable[[RelaySurvey], None] = lambda _: None
) -> tuple[RelaySurvey, ...]:
    """Ask the relays and return what they answered, in their order.

    on_answer: is told of each relay as soon as it has answered.
    """
    found: dict[str, RelaySurvey] = {}
    with without_logs(), ThreadPoolExecutor(AT_A_TIME) as pool:
        for future in as_completed([pool.submit(survey_relay, relay, settings) for relay in relays]):
            answer = future.result()
            found[answer.relay.name] = answer
            on_answer(answer)
    return tuple(found[relay.name] for relay in relays)


def survey_relay(relay: Relay, settings: Settings) -> RelaySurvey:
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
                return _asked(relay, client, settings)
            finally:
                limit.cancel()
    except (MmsError, CredentialFileError, AccessError) as error:
        return RelaySurvey(relay, unreachable=str(error))


def _asked(relay: Relay, client: Client, settings: Settings) -> RelaySurvey:
    offer = browse(client, relay.expected)
    if offer is None:
        acquisition = acquisition_from_scl(relay)
    else:
        acquisition = acquisition_from_offer(relay, offer, lambda control: _is_control(client, control))
    folder = EventFolder(relay.name, settings.events_directory, relay.overrides.events_directory)
    contents = folder.contents(client)
    directory = contents.directory
    records = () if directory is None else understand(contents.entries, directory).records
    return RelaySurvey(
        relay,
        name_plate={} if offer is None else _name_plate(client, offer),
        offer=offer,
        acquisition=acquisition,
        differences=0 if offer is None or relay.expected is None else len(differences(relay.expected, offer)),
        folder="/" if directory == ROOT else directory,
        no_folder=folder.missing,
        recordings=len(records),
        clock_offset_s=_clock_offset_s(client, acquisition),
    )


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


def _clock_offset_s(client: Client, acquisition: Acquisition) -> float | None:
    """Return how far the relay's clock is ahead, from a value that changes while it is read."""
    for measurand in acquisition.measurands:
        if measurand.quantity.is_statistic:
            continue
        before = stamp_of(client, measurand.stamp, FunctionalConstraint.MX)
        until_s = time.monotonic() + FAST_READING_S
        asked_ns = time.time_ns()
        while before is not None and time.monotonic() < until_s:
            time.sleep(FAST_PERIOD_S)
            stamp = stamp_of(client, measurand.stamp, FunctionalConstraint.MX)
            answered_ns = time.time_ns()
            if stamp is not None and stamp != before:
                reading = clock_reading(stamp, asked_ns=asked_ns, answered_ns=answered_ns)
                return reading.offset_ns / NANOSECONDS_PER_SECOND
            asked_ns = answered_ns
        return None
    return None
