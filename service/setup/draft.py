"""A plant as far as a list, its SCL files or its relays tell it: relays with motors, to be filled in."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import scl
from scl.ied_model import Ied
from service.configuration.problems import Problem
from service.plant.errors import PlantError
from service.plant.model import Relay
from service.plant.recognition import recognise
from service.plant.relay_entry import RELAY_NAME
from service.plant.relays import TEMPLATE
from service.setup.relay_survey import RelaySurvey

MOST_RELAYS = 1000


@dataclass(frozen=True, slots=True)
class DraftRelay:
    """A relay, and the motor that it protects.

    scl: its own SCL file; None where the SCD has it, or no file does.
    host: None where its SCL file has the address.
    needs_host: whether no source tells the address.
    motor: name of the motor as the SCD has it, else one made of the relay's name.
    has_motor_name: whether a source has the name of the motor.
    by_substation: whether the SCD binds motor and relay.
    site: where they are; empty where no source tells it.
    plate: what is known of the nameplate, by the keys of the motors file.
    told: what is known of the relay, in words.
    """

    name: str
    scl: Path | None = None
    host: str | None = None
    port: int | None = None
    needs_host: bool = False
    manufacturer: str = ""
    type: str = ""
    motor: str = ""
    description: str = ""
    by_substation: bool = False
    in_scd: bool = False
    told: tuple[str, ...] = ()
    has_motor_name: bool = False
    site: str = ""
    plate: Mapping[str, str | float | int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Draft:
    """A plant to be filled in.

    subnetworks: of the SCD, where it has several with addresses.
    left_out: what of the sources is not taken, in words.
    """

    relays: tuple[DraftRelay, ...]
    scd: Path | None = None
    subnetworks: tuple[str, ...] = ()
    left_out: tuple[str, ...] = field(default=())


def draft_of_scd(configuration: scl.Scl) -> Draft:
    """Return the motors of the Substation section, or else a motor for each relay that measures currents."""
    feeders = configuration.feeders()
    networks = tuple(
        network.name
        for network in configuration.communication
        if any(point.parameters.keys() & {"IP", "DNSName"} for point in network.connected_access_points)
    )
    subnetworks = networks if len(networks) > 1 else ()
    if feeders:
        relays = tuple(
            DraftRelay(
                feeder.ied,
                motor=feeder.motor,
                description=feeder.motor_description,
                needs_host=_address(configuration, configuration.ied(feeder.ied)) is None,
                by_substation=True,
                in_scd=True,
                told=tuple(_told(configuration.ied(feeder.ied))),
            )
            for feeder in feeders
        )
        return Draft(relays, configuration.path, subnetworks)
    taken = [ied for ied in configuration.ieds if recognise(ied).metering_data_set or _measures(ied)]
    others = [f"{ied.name} measures no currents" for ied in configuration.ieds if ied not in taken]
    if len(taken) > MOST_RELAYS:
        others.append(f"{len(taken) - MOST_RELAYS} relays beyond the first {MOST_RELAYS}")
    return Draft(
        tuple(
            DraftRelay(
                ied.name,
                motor=_motor_name(ied.name),
                needs_host=_address(configuration, ied) is None,
                in_scd=True,
                told=tuple(_told(ied)),
            )
            for ied in taken[:MOST_RELAYS]
        ),
        configuration.path,
        subnetworks,
        tuple(others),
    )


def draft_of_files(files: Sequence[scl.Scl]) -> Draft:
    """Return a relay for each CID, IID or ICD: named as its IED, or as its file where that is no name yet.

    Raises PlantError where no file describes one.
    """
    relays: list[DraftRelay] = []
    left_out: list[str] = []
    for configuration in files[:MOST_RELAYS]:
        named = [ied for ied in configuration.ieds if _measures(ied)] or list(configuration.ieds)
        if len(named) != 1:
            left_out.append(_without_one_ied(configuration))
            continue
        ied = named[0]
        is_template = ied.name == TEMPLATE
        name = free_name(configuration.path.stem if is_template else ied.name, relays)
        address = None if is_template else _address(configuration, ied)
        relays.append(
            DraftRelay(
                name,
                scl=configuration.path,
                needs_host=address is None,
                motor=_motor_name(name),
                told=(*_told(ied), *([] if address is None else [f"at {address}, as its file says"])),
            )
        )
    if not relays:
        expected = "the SCL file of one relay (CID, IID or ICD), or the SCD of a plant"
        raise PlantError(
            [
                Problem(str(configuration.path), "file", expected, words)
                for configuration, words in zip(files, left_out, strict=False)
            ]
        )
    return Draft(tuple(relays), left_out=tuple(left_out))


def _without_one_ied(configuration: scl.Scl) -> str:
    """Return in words that a file does not describe one relay, with what its reader left out."""
    number = len(configuration.ieds)
    words = f"{configuration.path.name} has {number or 'no'} IED{'' if number == 1 else 's'} that can be used"
    found = [str(each) for each in configuration.warnings if each.left_out and "<IED" in each.element]
    return "; ".join([words, *found[:3]])


def relays_to_ask(addresses: Iterable[scl.Address]) -> tuple[Relay, ...]:
    """Return relays of which only the address is known."""
    return tuple(
        Relay(
            name=f"R{number}",
            site="",
            host=address.host,
            port=address.port,
            manufacturer="",
            type="",
            trigger_control=None,
            record_made=None,
            fault_number=None,
            report_control=None,
            metering_data_set=None,
        )
        for number, address in enumerate(addresses, start=1)
    )


def draft_of_answers(answers: Iterable[RelaySurvey]) -> Draft:
    """Return a relay for each address, named as its logical devices are where it answered."""
    relays: list[DraftRelay] = []
    for answer in answers:
        devices = () if answer.offer is None else answer.offer.devices
        name = free_name(_ied_name(devices) or answer.relay.name, relays)
        plate = answer.name_plate or {}
        relays.append(
            DraftRelay(
                name,
                host=answer.relay.host,
                port=answer.relay.port,
                manufacturer=plate.get("vendor", ""),
                type=plate.get("model", ""),
                motor=_motor_name(name),
                told=tuple(_answered(answer, devices)),
            )
        )
    return Draft(tuple(relays))


def _answered(answer: RelaySurvey, devices: Sequence[str]) -> Iterator[str]:
    found = answer.acquisition
    if answer.unreachable is not None or found is None:
        yield f"it did not answer: {answer.unreachable}"
        return
    yield f"logical devices: {', '.join(devices[:20]) or 'it does not tell'}"
    yield f"trigger: {found.trigger}" if found.trigger else f"no trigger: {found.no_trigger}"
    yield f"report: {found.report_controls[0]}" if found.report_controls else "no report: it is polled"
    yield f"{answer.recordings} recordings in {answer.folder}" if answer.folder else f"{answer.no_folder}"


def _told(ied: Ied) -> Iterator[str]:
    words = " ".join(filter(None, (ied.manufacturer, ied.type)))
    if words:
        yield words
    if ied.description:
        yield ied.description
    points = recognise(ied)
    if points.trigger is not None:
        yield f"trigger: {points.trigger}"
    yield from points.missing


def _measures(ied: Ied) -> bool:
    return any(ied.data_objects(ln_class="MMXU", name="A"))


def _address(configuration: scl.Scl, ied: Ied) -> scl.Address | None:
    try:
        return configuration.address(ied.name)
    except scl.SclError:
        return None


def _ied_name(devices: Sequence[str]) -> str:
    """Return what the names of all logical devices begin with, which is the IED's name (IEC 61850-7-2)."""
    shortest = min(devices, key=len, default="")
    for length in range(len(shortest), 0, -1):
        beginning = shortest[:length]
        if all(device.startswith(beginning) for device in devices):
            return beginning
    return ""


def free_name(wanted: str, relays: Sequence[DraftRelay]) -> str:
    """Return a name that a relay may have and none has yet."""
    plain = re.sub(r"[^A-Za-z0-9_.-]", "_", wanted)[:60].lstrip("_.-")
    name = plain if RELAY_NAME.fullmatch(plain) else f"R{len(relays) + 1}"
    taken = {relay.name for relay in relays}
    numbered = (f"{name}_{number}" for number in range(2, len(relays) + 3))
    return name if name not in taken else next(each for each in numbered if each not in taken)


def _motor_name(relay: str) -> str:
    return f"MOTOR-OF-{relay}"
