"""What the service recognises in a relay's model: how to trigger it, and what tells of its records."""

from collections.abc import Iterable
from dataclasses import dataclass

from scl.data_model import Ied

REMOTE_BIT = "RBGGIO1.SPCSO01"
"""Remote bit RB01 of the SEL-700 family, which the relay's event report trigger equation (ER) listens to."""


@dataclass(frozen=True, slots=True)
class RecognisedPoints:
    """References of the points, None for those the model lacks; `missing` says in words what that means.

    trigger: a control that has the relay record an event.  record_made, record_number: status of its
    recorder.  report_control: a buffered report whose data set holds record_made.  metering_data_set: one
    that holds the currents.
    """

    trigger: str | None
    record_made: str | None
    record_number: str | None
    report_control: str | None
    metering_data_set: str | None
    missing: tuple[str, ...]


def recognise(ied: Ied) -> RecognisedPoints:
    """The points of one relay."""
    trigger = trigger_control(ied)
    record_made = _first(placed.reference for placed in ied.data_objects(ln_class="RDRE", name="RcdMade"))
    reports = () if record_made is None else ied.report_controls(buffered=True, covering=record_made)
    report_control = _first(reference for report in reports for reference in report.references)
    metering = _metering_data_set(ied)
    missing = {
        "no control that makes a record (remote bit RB01, or RcdTrg of an RDRE): "
        "it records what it records itself": trigger is None,
        "no RcdMade of an RDRE: records are found by listing its directory": record_made is None,
        "no buffered report that holds RcdMade: records are found by listing its directory": (
            record_made is not None and report_control is None
        ),
        "no data set with the currents of an MMXU": metering is None,
    }
    return RecognisedPoints(
        trigger=trigger,
        record_made=record_made,
        record_number=_first(placed.reference for placed in ied.data_objects(ln_class="RDRE", name="FltNum")),
        report_control=report_control,
        metering_data_set=metering,
        missing=tuple(words for words, lacks in missing.items() if lacks),
    )


def trigger_control(ied: Ied) -> str | None:
    """Reference of the control that has this relay record an event; None where it offers none."""
    controls = [placed.reference for placed in ied.data_objects(common_data_class="SPC")]
    recorders = (placed.reference for placed in ied.data_objects(ln_class="RDRE", name="RcdTrg"))
    bits = (reference for reference in controls if reference.endswith(f"/{REMOTE_BIT}"))
    return _first(bits) or _first(reference for reference in recorders if reference in controls)


def _metering_data_set(ied: Ied) -> str | None:
    currents = _first(placed.reference for placed in ied.data_objects(ln_class="MMXU", name="A"))
    if currents is None:
        return None
    return _first(data_set.reference for data_set in ied.data_sets() if data_set.covers(currents))


def _first(references: Iterable[str]) -> str | None:
    return next(iter(references), None)
