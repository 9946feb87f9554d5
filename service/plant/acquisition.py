"""How recordings are acquired from a relay: what the service uses, and where that differs from its SCL.

An entry of the motors file comes first. Then comes what the relay itself offers, or what its SCL says where
the relay could not be asked.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass

from service.plant.metering import Measurand, measurands_from_offer
from service.plant.model import Relay
from service.plant.offer import Offer
from service.plant.overrides import NONE, TriggerAction
from service.plant.recognition import NO_TRIGGER, recognise_offer

_REMOTE_BITS = re.compile(r"/RBGGIO\d+\.SPCSO\d+$")


@dataclass(frozen=True, slots=True)
class Deviation:
    """Something the service uses that differs from the relay's SCL, and what is done about it.

    subject: "trigger", "record-made", "reports", "metering".
    """

    subject: str
    reason: str


@dataclass(frozen=True, slots=True)
class Acquisition:
    """What is used of one relay; None or empty where the relay lacks it.

    trigger: the control that makes a record.
    no_trigger: why there is none.
    record_made, record_number: status of its recorder.
    report_controls: report control blocks that announce a record, the best one first.
    asked: whether the relay itself was asked; otherwise this is what its SCL says.
    """

    trigger: str | None
    trigger_action: TriggerAction
    no_trigger: str
    record_made: str | None
    record_number: str | None
    report_controls: tuple[str, ...]
    measurands: tuple[Measurand, ...]
    asked: bool
    deviations: tuple[Deviation, ...] = ()


def acquisition_from_scl(relay: Relay) -> Acquisition:
    """Return what the relay offers by its SCL alone."""
    overrides = relay.overrides
    return Acquisition(
        trigger=_chosen(overrides.trigger, relay.trigger_control),
        trigger_action=overrides.trigger_action or _action(_chosen(overrides.trigger, relay.trigger_control)),
        no_trigger=_no_trigger(relay),
        record_made=relay.record_made,
        record_number=relay.fault_number,
        report_controls=_reports(overrides.report_control, _promised_reports(relay)),
        measurands=relay.measurands,
        asked=False,
    )


def acquisition_from_offer(relay: Relay, offer: Offer, is_control: Callable[[str], bool]) -> Acquisition:
    """Return what the relay itself offers. is_control: whether one of its data objects can be operated."""
    overrides = relay.overrides
    promises = [
        relay.trigger_control,
        relay.record_made,
        relay.fault_number,
        *_promised_reports(relay),
        relay.metering_data_set,
    ]
    points = recognise_offer(offer, is_control, [promise for promise in promises if promise is not None])
    trigger = _chosen(overrides.trigger, points.trigger)
    measurands = measurands_from_offer(offer, relay.measurands)
    deviations = (
        _deviation(relay, "trigger", relay.trigger_control, points.trigger, "it cannot be asked for a record")
        if overrides.trigger is None
        else _overridden_trigger(trigger, offer),
        _deviation(relay, "record-made", relay.record_made, points.record_made, "its directory is polled"),
        _deviation(
            relay, "reports", relay.report_control, points.report_control, "others are tried, or polling"
        )
        if overrides.report_control is None
        else None,
        _metering(relay.measurands, measurands),
    )
    return Acquisition(
        trigger=trigger,
        trigger_action=overrides.trigger_action or _action(trigger),
        no_trigger=_no_trigger(relay),
        record_made=points.record_made,
        record_number=points.record_number,
        report_controls=_reports(overrides.report_control, points.report_controls),
        measurands=measurands,
        asked=True,
        deviations=tuple(found for found in deviations if found is not None),
    )


def _promised_reports(relay: Relay) -> tuple[str, ...]:
    """Return the report control of the SCL, then the others that announce a record too."""
    first = () if relay.report_control is None else (relay.report_control,)
    if relay.expected is None or relay.record_made is None:
        return first
    recognised = recognise_offer(relay.expected, lambda _reference: False, first)
    return tuple(dict.fromkeys((*first, *recognised.report_controls)))


def _chosen(override: str | None, recognised: str | None) -> str | None:
    if override == NONE:
        return None
    return override or recognised


def _reports(override: str | None, recognised: tuple[str, ...]) -> tuple[str, ...]:
    if override == NONE:
        return ()
    return recognised if override is None else (override,)


def _action(trigger: str | None) -> TriggerAction:
    is_bit = trigger is not None and _REMOTE_BITS.search(trigger) is not None
    return TriggerAction.SET_RESET if is_bit else TriggerAction.PULSE


def _no_trigger(relay: Relay) -> str:
    if relay.overrides.trigger == NONE:
        return "the motors file says that it is not to be triggered"
    return f"it offers {NO_TRIGGER}"


def _deviation(
    relay: Relay, subject: str, expected: str | None, found: str | None, consequence: str
) -> Deviation | None:
    if expected is None or expected == found:
        return None
    if found is not None and not relay.scl_knows_names and _in_device(expected) == _in_device(found):
        return None
    if found is None:
        return Deviation(subject, f"expected {expected}, as its SCL says, found none: {consequence}")
    return Deviation(subject, f"expected {expected}, as its SCL says, found and used {found}")


def _in_device(reference: str) -> str:
    """Return a reference without its logical device."""
    return reference.partition("/")[2]


def _overridden_trigger(trigger: str | None, offer: Offer) -> Deviation | None:
    if trigger is None or offer.has(trigger):
        return None
    return Deviation("trigger", f"expected {trigger}, as the motors file says, found none")


def _metering(expected: tuple[Measurand, ...], found: tuple[Measurand, ...]) -> Deviation | None:
    lost = {each.quantity for each in expected} - {each.quantity for each in found}
    if not lost:
        return None
    return Deviation("metering", f"its SCL says that it measures {', '.join(sorted(lost))}; it does not")
