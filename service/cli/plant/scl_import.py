"""`mcc import-scl`: what the service finds in an SCL file."""

from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.console import RenderableType
from rich.text import Text

import scl
from core.error_words import one_line
from scl import Address, Scl, SclError
from scl.ied_model import Ied
from service.cli.output import failing_clearly, print_document, results
from service.client.tables import FittedTable
from service.plant.recognition import recognise


def show_scl(file: Path, *, as_json: bool) -> None:
    """Read the file and print sites, motors, relays and what the relays offer.

    Raises CommandError where the file cannot be used.
    """
    with failing_clearly(SclError, OSError):
        document = scl.read(file)
        found = describe(document)
    if as_json:
        print_document(found)
        return
    console = results()
    console.print(_motors(document))
    console.print(_relays(document))
    for ied in document.ieds:
        for words in recognise(ied).missing:
            console.print(Text(f"{ied.name}: not recognised: {words}"), soft_wrap=True)
    for warning in _warnings(document):
        console.print(Text(f"warning: {one_line(warning)}", style="yellow"), soft_wrap=True)


def describe(document: Scl) -> dict[str, object]:
    """Return the file's contents as a JSON document."""
    return {
        "file": str(document.path),
        "motors": [
            {
                "motor": feeder.motor,
                "description": feeder.motor_description,
                "site": feeder.site,
                "site_description": feeder.site_description,
                "bay": feeder.bay,
                "relay": feeder.ied,
                "bus": feeder.bus,
            }
            for feeder in document.feeders()
        ],
        "relays": [_describe_relay(document, ied) for ied in document.ieds],
        "warnings": _warnings(document),
    }


def _describe_relay(document: Scl, ied: Ied) -> dict[str, object]:
    address = _usable_address(document, ied.name)
    return {
        "relay": ied.name,
        "manufacturer": ied.manufacturer,
        "type": ied.type,
        "description": ied.description,
        "host": None if address is None else address.host,
        "port": None if address is None else address.port,
        "logical_devices": [device.name for device in ied.logical_devices],
        "data_sets": [data_set.reference for data_set in ied.data_sets()],
        "buffered_reports": [
            reference for report in ied.report_controls(buffered=True) for reference in report.references
        ],
        "record_made": [placed.reference for placed in ied.data_objects(ln_class="RDRE", name="RcdMade")],
        "trigger": recognise(ied).trigger,
        "report": recognise(ied).report_control,
        "metering": recognise(ied).metering_data_set,
        "not_recognised": list(recognise(ied).missing),
        "controls": [placed.reference for placed in ied.data_objects(common_data_class="SPC")],
    }


def _warnings(document: Scl) -> list[str]:
    """Return the reader's warnings, and every address that the service could not use."""
    warnings = [str(warning) for warning in document.warnings]
    addressed = []
    for ied in document.ieds:
        try:
            if _address(document, ied.name) is not None:
                addressed.append(ied.name)
        except SclError as error:
            warnings.append(str(error))
    for address, sharing in document.shared_addresses(addressed).items():
        warnings.append(f"relays {' and '.join(sharing)} have the same address, {address}")
    return warnings


def _address(document: Scl, ied_name: str) -> Address | None:
    """Return the address of a relay; None without one, as in an ICD. Raises SclError if unusable."""
    try:
        document.connected_access_point(ied_name)
    except SclError:
        return None
    return document.address(ied_name)


def _usable_address(document: Scl, ied_name: str) -> Address | None:
    """Return the address of a relay; None also for an unusable one, which is among the warnings."""
    try:
        return _address(document, ied_name)
    except SclError:
        return None


def _motors(document: Scl) -> RenderableType:
    if not document.feeders():
        return Text('no motors: no ConductingEquipment type="MOT" with an LNode of its relay')
    table = FittedTable(title="Motors", title_justify="left", box=SIMPLE_HEAD, collapse_padding=True)
    feeders = document.feeders()
    knows_buses = any(feeder.bus for feeder in feeders)
    for heading in ("site", "bay", "motor", "description", "relay", *(["bus"] if knows_buses else [])):
        table.add_column(heading)
    for feeder in feeders:
        words = (feeder.site, feeder.bay, feeder.motor, feeder.motor_description, feeder.ied)
        table.add_row(*(Text(word or "") for word in (*words, *([feeder.bus] if knows_buses else []))))
    return table


def _relays(document: Scl) -> FittedTable:
    """Return the table of relays; references leave out the relay's name at their beginning."""
    table = FittedTable(title="Relays", title_justify="left", box=SIMPLE_HEAD, collapse_padding=True)
    for heading in ("relay\nmake", "address"):
        table.add_column(heading, no_wrap=True)
    for heading in ("devices", "reports"):
        table.add_column(heading)
    table.add_column("record made\ntrigger", no_wrap=True)
    for ied in document.ieds:
        address = _usable_address(document, ied.name)
        reports = sum(len(report.references) for report in ied.report_controls(buffered=True))
        made = [placed.reference for placed in ied.data_objects(ln_class="RDRE", name="RcdMade")]
        trigger = recognise(ied).trigger or "no trigger"
        table.add_row(
            Text(f"{ied.name}\n{ied.manufacturer} {ied.type}".strip()),
            Text("none" if address is None else str(address)),
            Text(" ".join(device.inst for device in ied.logical_devices)),
            str(reports),
            Text("\n".join(reference.removeprefix(ied.name) for reference in (*made, trigger))),
        )
    return table
