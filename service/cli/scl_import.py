"""`mcc import-scl`: what an SCL file describes, as far as the service is concerned."""

from pathlib import Path

from rich.table import Table
from rich.text import Text

import scl
from scl import Scl, SclError
from scl.data_model import Ied
from service.cli.output import failing_clearly, print_document, results


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
    for warning in document.warnings:
        console.print(Text(f"warning: {warning}", style="yellow"))


def describe(document: Scl) -> dict[str, object]:
    """The file's contents as a JSON document."""
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
            }
            for feeder in document.feeders()
        ],
        "relays": [_describe_relay(document, ied) for ied in document.ieds],
        "warnings": [str(warning) for warning in document.warnings],
    }


def _describe_relay(document: Scl, ied: Ied) -> dict[str, object]:
    address = _address(document, ied.name)
    return {
        "relay": ied.name,
        "manufacturer": ied.manufacturer,
        "type": ied.type,
        "description": ied.description,
        "host": None if address is None else address[0],
        "port": None if address is None else address[1],
        "logical_devices": [device.name for device in ied.logical_devices],
        "data_sets": [data_set.reference for data_set in ied.data_sets()],
        "buffered_reports": [
            reference for report in ied.report_controls(buffered=True) for reference in report.references
        ],
        "record_made": [placed.reference for placed in ied.data_objects(ln_class="RDRE", name="RcdMade")],
        "controls": [placed.reference for placed in ied.data_objects(common_data_class="SPC")],
    }


def _address(document: Scl, ied_name: str) -> tuple[str, int] | None:
    """An ICD describes a kind of relay and has no address yet."""
    try:
        address = document.address(ied_name)
    except SclError:
        return None
    return address.host, address.port


def _motors(document: Scl) -> Table:
    table = Table(title="Motors", title_justify="left")
    for heading in ("site", "bay", "motor", "description", "relay"):
        table.add_column(heading)
    for feeder in document.feeders():
        words = (feeder.site, feeder.bay, feeder.motor, feeder.motor_description, feeder.ied)
        table.add_row(*(Text(word or "") for word in words))
    return table


def _relays(document: Scl) -> Table:
    table = Table(title="Relays", title_justify="left")
    for heading in ("relay", "make", "address"):
        table.add_column(heading, no_wrap=True)
    for heading in ("logical devices", "reports", "record made"):
        table.add_column(heading, overflow="fold")
    for ied in document.ieds:
        address = _address(document, ied.name)
        reports = sum(len(report.references) for report in ied.report_controls(buffered=True))
        made = [placed.reference for placed in ied.data_objects(ln_class="RDRE", name="RcdMade")]
        table.add_row(
            Text(ied.name),
            Text(f"{ied.manufacturer} {ied.type}".strip()),
            Text("none" if address is None else f"{address[0]}:{address[1]}"),
            Text(" ".join(device.inst for device in ied.logical_devices)),
            str(reports),
            Text(" ".join(made)),
        )
    return table
