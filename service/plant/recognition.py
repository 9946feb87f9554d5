"""Recognises in a relay's model how the relay is triggered and how it announces its records.

The same rules serve for an SCL file and for what a relay itself offers.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from scl.ied_model import Ied
from service.plant.offer import Offer, offer_from_scl

REMOTE_BIT = "RBGGIO1.SPCSO01"
"""This is remote bit RB01 of the SEL-700 family; the event report trigger equation (ER) is set to it."""

RECORD_TRIGGER = "RcdTrg"
"""This data object of an RDRE (IEC 61850-7-4) goes back by itself."""

NO_TRIGGER = (
    "no control that makes a record (remote bit RB01, or RcdTrg of an RDRE): "
    "it records what it records itself"
)
NO_RECORD_MADE = "no RcdMade of an RDRE: records are found by listing its directory"
NO_BUFFERED_REPORT = "no buffered report that holds RcdMade: records are found by listing its directory"
NO_CURRENTS = "no data set with the currents of an MMXU"


@dataclass(frozen=True, slots=True)
class RecognisedPoints:
    """References of the points, None for those that the model lacks.

    trigger: a control that makes the relay record an event.
    record_made, record_number: status of its recorder.
    report_controls: reports whose data set holds record_made, buffered ones first.
    report_control: the first buffered one.
    metering_data_set: a data set that holds the currents.
    missing: what the model lacks, and what follows from that, in words.
    """

    trigger: str | None
    record_made: str | None
    record_number: str | None
    report_controls: tuple[str, ...]
    metering_data_set: str | None

    @property
    def report_control(self) -> str | None:
        return next((reference for reference in self.report_controls if ".BR." in reference), None)

    @property
    def missing(self) -> tuple[str, ...]:
        missing = {
            NO_TRIGGER: self.trigger is None,
            NO_RECORD_MADE: self.record_made is None,
            NO_BUFFERED_REPORT: self.record_made is not None and self.report_control is None,
            NO_CURRENTS: self.metering_data_set is None,
        }
        return tuple(words for words, lacks in missing.items() if lacks)


def recognise(ied: Ied) -> RecognisedPoints:
    """Return the points of one relay, from its SCL."""
    controls = {placed.reference for placed in ied.data_objects(common_data_class="SPC")}
    return recognise_offer(offer_from_scl(ied), controls.__contains__)


def recognise_offer(
    offer: Offer, is_control: Callable[[str], bool], expected: Sequence[str] = ()
) -> RecognisedPoints:
    """Return the points among what is offered.

    is_control: whether a data object can be operated. It is called for a few candidates only.
    expected: references to prefer where there is a choice, or their namesakes in a logical device of another
    name.
    """

    def order(references: Iterable[str]) -> list[str]:
        return sorted(references, key=lambda found: _rank(found, expected))

    bits = order(f"{node}.SPCSO01" for node in offer.nodes if node.endswith("/RBGGIO1"))
    triggers = [*filter(offer.has, bits), *order(offer.objects("RDRE", RECORD_TRIGGER))]
    triggers.sort(key=lambda found: _rank(found, expected))
    record_made = next(iter(order(offer.objects("RDRE", "RcdMade"))), None)
    recorder = "" if record_made is None else record_made.partition(".")[0]
    numbers = order(offer.objects("RDRE", "FltNum"))
    numbers.sort(key=lambda found: found.partition(".")[0] != recorder)
    return RecognisedPoints(
        trigger=next(filter(is_control, triggers), None),
        record_made=record_made,
        record_number=next(iter(numbers), None),
        report_controls=() if record_made is None else tuple(_reports(offer, record_made, expected)),
        metering_data_set=_metering_data_set(offer, expected),
    )


def _reports(offer: Offer, record_made: str, expected: Sequence[str]) -> list[str]:
    telling = set(offer.data_sets_covering(record_made))
    blocks = [block for block in offer.report_blocks if block.data_set in telling]
    blocks.sort(key=lambda block: (not block.buffered, _rank(block.reference, expected)))
    return [block.reference for block in blocks]


def _metering_data_set(offer: Offer, expected: Sequence[str]) -> str | None:
    currents = next(iter(offer.objects("MMXU", "A")), None)
    if currents is None:
        return None
    found = sorted(offer.data_sets_covering(currents), key=lambda data_set: _rank(data_set, expected))
    return next(iter(found), None)


def _rank(reference: str, expected: Sequence[str]) -> int:
    """Return a reference's sort key: expected ones first, then namesakes in other logical devices."""
    if reference in expected:
        return expected.index(reference)
    tails = {known.partition("/")[2] for known in expected}
    return len(expected) + (reference.partition("/")[2] not in tails)
