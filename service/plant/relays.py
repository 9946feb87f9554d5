"""Relays as the plant's files describe them: an IED of the SCD, one of its own SCL file, or an address."""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import scl
from scl.configuration import MMS_PORT
from scl.ied_model import Ied
from service.configuration.problems import Problem, Problems
from service.plant.errors import PlantError
from service.plant.metering import measurands_from_scl
from service.plant.model import Relay
from service.plant.motors_file import MotorsFile
from service.plant.offer import offer_from_scl
from service.plant.overrides import Overrides
from service.plant.recognition import recognise
from service.plant.relay_entry import RelayEntry

MOST_OMISSIONS = 20

TEMPLATE = "TEMPLATE"
"""The IED of an ICD has this name, which says that its own is yet to be given (IEC 61850-6)."""


def relay_of_ied(
    configuration: scl.Scl,
    ied: Ied,
    site: str,
    entry: RelayEntry,
    overrides: Overrides,
    problems: Problems,
    *,
    knows_names: bool = True,
) -> Relay:
    """Return a relay that has an SCL file; the motors file wins where it says more.

    knows_names: whether the SCL knows how its logical devices are called.

    Another address than that of the SCL file is a warning. Raises PlantError.
    """
    address = _address(configuration, ied.name, entry)
    host = entry.host or (address.host if address else "")
    port = entry.port or (address.port if address else MMS_PORT)
    if address is not None and (host, port) != (address.host, address.port):
        problems.warnings.append(
            f"relay {entry.name}: its address is {scl.Address(host, port)}, as the motors file says, not "
            f"{address}, as {configuration.path.name} does"
        )
    points = recognise(ied)
    return Relay(
        name=entry.name,
        site=site,
        host=host,
        port=port,
        manufacturer=entry.manufacturer or ied.manufacturer,
        type=entry.type or ied.type,
        trigger_control=points.trigger,
        record_made=points.record_made,
        fault_number=points.record_number,
        report_control=points.report_control,
        metering_data_set=points.metering_data_set,
        measurands=measurands_from_scl(ied),
        expected=offer_from_scl(ied),
        overrides=overrides,
        time_zone=entry.time_zone,
        scl_knows_names=knows_names,
    )


def relay_without_scl(entry: RelayEntry, site: str, told: MotorsFile, overrides: Overrides) -> Relay:
    """Return a relay of which only the address is known: it is asked what it offers. Raises PlantError."""
    if entry.host is None:
        expected = "the relay's address (host), or its CID with an address (scl)"
        raise PlantError([told.problem("relay", entry.name, "host", expected=expected, found="none")])
    return Relay(
        name=entry.name,
        site=site,
        host=entry.host,
        port=entry.port or MMS_PORT,
        manufacturer=entry.manufacturer or "",
        type=entry.type or "",
        trigger_control=None,
        record_made=None,
        fault_number=None,
        report_control=None,
        metering_data_set=None,
        overrides=overrides,
        time_zone=entry.time_zone,
    )


@dataclass(frozen=True, slots=True)
class OwnScl:
    """The SCL file of one relay, and its IED in it.

    is_icd: whether it describes the relay's type, and knows neither its name nor its address.
    """

    configuration: scl.Scl
    ied: Ied
    is_icd: bool


def read_own_scl(entry: RelayEntry, told: MotorsFile, subnetwork: str | None) -> OwnScl:
    """Read the SCL file of one relay, and find its IED: the one of its name, or the only one.

    Raises PlantError.
    """
    file, is_icd = entry.scl or told.path, False
    try:
        configuration = scl.read(file)
        if [ied.name for ied in configuration.ieds] == [TEMPLATE]:
            is_icd = True
            if entry.host is None:
                expected = f"the relay's address, which {file.name} cannot know: it is an ICD"
                raise PlantError([told.problem("relay", entry.name, "host", expected=expected, found="none")])
            # The address in an ICD is that of any relay of its type.
            configuration = replace(_named(file, entry.name), communication=())
        if subnetwork in [network.name for network in configuration.communication]:
            configuration = configuration.seen_from(str(subnetwork))
    except scl.SclError as error:
        raise PlantError([scl_problem(error)]) from error
    names = [ied.name for ied in configuration.ieds]
    if entry.name in names or len(names) == 1:
        ied = configuration.ied(entry.name if entry.name in names else names[0])
        return OwnScl(configuration, ied, is_icd)
    expected = f"a file with one IED, or with one called {entry.name}"
    found = f"{file.name} with {', '.join(names[:20]) or 'none'}"
    raise PlantError([told.problem("relay", entry.name, "scl", expected=expected, found=found)])


def omissions(configuration: scl.Scl) -> list[str]:
    """Return what is left out of an SCL file, in words; of very much the beginning."""
    left_out = [str(warning) for warning in configuration.warnings if warning.left_out]
    told = [f"{configuration.path.name}: {warning}" for warning in left_out[:MOST_OMISSIONS]]
    if more := left_out[MOST_OMISSIONS:]:
        told.append(f"{configuration.path.name}: {len(more)} more are left out: mcc import-scl lists them")
    return told


def scl_problem(error: scl.SclError) -> Problem:
    """Return what is wrong in an SCL file."""
    line = "" if error.line is None else f"line {error.line}: "
    return Problem(str(error.path), f"{line}{error.element or 'file'}", error.expected, error.found)


def _named(file: Path, name: str) -> scl.Scl:
    """Read an ICD as if its IED had the relay's name: logical devices are called by it. Raises SclError.

    A relay may be called R-1 or 3UF7, which no IED may (IEC 61850-6). What its devices are really called, the
    relay says.
    """
    word = re.sub(r"[^A-Za-z0-9_]", "_", name)
    name = word if word[:1].isalpha() else f"R{word}"
    with TemporaryDirectory() as folder:
        instance = Path(folder) / file.name
        scl.instantiate(file, instance, name)
        return scl.read(instance)


def _address(configuration: scl.Scl, ied_name: str, entry: RelayEntry) -> scl.Address | None:
    """Return the address in the SCL file; None where the motors file has the host and the SCL no address.

    Raises PlantError.
    """
    try:
        return configuration.address(ied_name)
    except scl.SclError as error:
        if entry.host is not None:
            return None
        raise PlantError([scl_problem(error)]) from error
