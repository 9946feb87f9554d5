"""The data model of an IED as the .cfg text that libiec61850's ConfigFileParser reads.

The parser knows no escapes: it reads lines of less than 1024 bytes, ends a word at a blank and a string at
the first quote, and takes a line that ends in "{" for the start of a block. What the text cannot carry is
left out (initial values of bit strings, say) or refused (names longer than the parser's buffers).
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from scl.configuration import Scl
from scl.control_block_model import (
    DataSetMember,
    GooseControl,
    LogControl,
    MulticastAddress,
    ReportControl,
    SampledValueControl,
)
from scl.data_model import DataAttribute, DataObject, FunctionalConstraint
from scl.errors import SclError
from scl.ied_model import Ied, LogicalDevice
from scl.logical_node import LogicalNode

LONGEST_WORD = 128
LONGEST_LINE_BYTES = 1000
MOST_LINES = 1_000_000
TRANSIENT = 128
OWNER_SHOWN = 64

# Numbers of libiec61850's enums FunctionalConstraint and DataAttributeType.
CONSTRAINTS = {constraint: number for number, constraint in enumerate(FunctionalConstraint)}
TYPES = {
    "BOOLEAN": 0,
    "INT8": 1,
    "INT16": 2,
    "INT24": 3,
    "INT32": 3,
    "INT64": 4,
    "INT128": 5,
    "INT8U": 6,
    "INT16U": 7,
    "INT24U": 8,
    "INT32U": 9,
    "FLOAT32": 10,
    "FLOAT64": 11,
    "Enum": 12,
    "Octet16": 13,  # the library has octet strings of 6, of 8 and of up to 64
    "Octet64": 13,
    "Octet6": 14,
    "EntryID": 15,
    "VisString32": 16,
    "VisString64": 17,
    "VisString65": 18,
    "VisString129": 19,
    "ObjRef": 19,
    "VisString255": 20,
    "Unicode255": 21,
    "Timestamp": 22,
    "Quality": 23,
    "Check": 24,
    "Dbpos": 25,
    "Tcmd": 25,
    "Struct": 27,
    "EntryTime": 28,
    "PhyComAddr": 29,
    "Currency": 30,
    "OptFlds": 31,
    "SvOptFlds": 31,
    "LogOptFlds": 31,
    "TrgOps": 32,
}
INTEGER_RANGES = {
    "INT8": (-(2**7), 2**7 - 1),
    "INT16": (-(2**15), 2**15 - 1),
    "INT24": (-(2**23), 2**23 - 1),
    # The parser reads every signed number into 32 bits.
    "INT32": (-(2**31), 2**31 - 1),
    "INT64": (-(2**31), 2**31 - 1),
    "INT128": (-(2**31), 2**31 - 1),
    "INT8U": (0, 2**8 - 1),
    "INT16U": (0, 2**16 - 1),
    "INT24U": (0, 2**24 - 1),
    "INT32U": (0, 2**32 - 1),
}
STRING_LENGTHS = {
    "VisString32": 32,
    "VisString64": 64,
    "VisString65": 65,
    "VisString129": 129,
    "VisString255": 255,
    "Unicode255": 255,
    "ObjRef": 129,
    "Currency": 3,
}


def model_text(scl: Scl, ied_name: str) -> str:
    """Write the .cfg text of one IED: the logical devices of all its access points together.

    Parameters
    ----------
    scl : Scl
        The configuration.
    ied_name : str
        Name of the IED.

    Returns
    -------
    str
        The text.

    Raises
    ------
    SclError
        The file has no such IED, it serves no data, or a name is too long for the parser.
    """
    ied = scl.ied(ied_name)
    if not ied.logical_devices:
        raise SclError(
            scl.path,
            element=f'<IED name="{ied_name}">',
            expected="an access point with a Server and LDevices",
            found="none",
        )
    if not any(node.data_objects for node in ied.logical_nodes()):
        raise SclError(
            scl.path,
            element=f'<IED name="{ied_name}">',
            expected="a logical node with data objects that a server can offer",
            found="none: see the warnings of the file",
        )
    lines: list[str] = []
    for line in _model(ied):
        if _is_too_long(line) or len(lines) >= MOST_LINES:
            raise SclError(
                scl.path,
                element=f'<IED name="{ied_name}">',
                expected=f"a model of at most {MOST_LINES} lines, {LONGEST_WORD} characters a name",
                found=f"more, at {line[:60]}",
            )
        lines.append(line)
    return "\n".join(lines) + "\n"


def _is_too_long(line: str) -> bool:
    if len(line) <= LONGEST_WORD:  # then no word of it is too long either
        return False
    words = line.partition("=")[0].split()
    return len(line.encode()) > LONGEST_LINE_BYTES or max(map(len, words)) > LONGEST_WORD


def _model(ied: Ied) -> Iterator[str]:
    """Yield the lines of a model. A domain is called by IED name and inst, or by an ldName of its own.

    The library cannot lead a data set of a domain with a name of its own to members in another. With such a
    domain in the IED the model has no name, and every logical device carries its domain's whole name as inst.
    """
    own_names = any(device.named for device in ied.logical_devices)
    domains = {device.inst: device.name if own_names else device.inst for device in ied.logical_devices}
    yield "MODEL{" if own_names else f"MODEL({ied.name}){{"
    for device in ied.logical_devices:
        yield f"LD({domains[device.inst]}){{"
        for node in device.logical_nodes:
            yield from _node(ied, device, node, domains)
        yield "}"
    yield "}"


def _node(ied: Ied, device: LogicalDevice, node: LogicalNode, domains: Mapping[str, str]) -> Iterator[str]:
    yield f"LN({node.name}){{"
    if node.setting_groups is not None and node.name == "LLN0":
        yield f"SG({node.setting_groups.active} {node.setting_groups.number})"
    for data_object in node.data_objects:
        yield from _object(data_object, transient=False)
    for data_set in node.data_sets:
        yield f"DS({data_set.name}){{"
        for member in data_set.members:
            yield from _member(ied, device, member, domains)
        yield "}"
    for report in node.report_controls:
        yield from _report(report, owner=ied.reports_show_owner)
    for log_control in node.log_controls:
        yield _log_control(domains[device.inst], node, log_control)
    for log in node.logs:
        yield f"LOG({log});"
    for goose in node.goose_controls:
        yield from _goose(goose)
    for stream in node.sampled_value_controls:
        yield from _sampled_values(stream)
    yield "}"


def _object(data_object: DataObject, *, transient: bool) -> Iterator[str]:
    transient = transient or data_object.transient
    yield f"DO({data_object.name} {data_object.count}){{"
    yield from _elements(data_object.count, list(_object_parts(data_object, transient=transient)))
    yield "}"


def _object_parts(data_object: DataObject, *, transient: bool) -> Iterator[str]:
    for part in data_object.objects:
        yield from _object(part, transient=transient)
    for attribute in data_object.attributes:
        if attribute.name == "ctlModel" and attribute.value is None:
            attribute = replace(attribute, value=_control_model(data_object))
        if attribute.fc is FunctionalConstraint.SE:
            # An editable setting is also read as the active group's. libiec61850 needs both, SG first.
            yield from _attribute(attribute, FunctionalConstraint.SG, transient=transient)
        yield from _attribute(attribute, attribute.fc, transient=transient)


def _control_model(data_object: DataObject) -> str | None:
    """Return the control model that an object's attributes allow, where the file gives none."""
    names = {attribute.name for attribute in data_object.attributes}
    if "SBOw" in names:
        return "4"  # select before operate with enhanced security
    if "SBO" in names:
        return "2"
    return "1" if "Oper" in names else None


def _elements(count: int, parts: list[str]) -> Iterator[str]:
    """Yield the parts of an object or struct; of an array, once for each element."""
    if not count:
        yield from parts
    for index in range(count):
        yield f"[{index}]{{"
        yield from parts
        yield "}"


def _attribute(
    attribute: DataAttribute, constraint: FunctionalConstraint, *, transient: bool
) -> Iterator[str]:
    kind = TYPES.get(attribute.basic_type)
    if kind is None:
        return
    triggers = attribute.trigger_options.value | (TRANSIENT if transient else 0)
    head = f"DA({attribute.name} {attribute.count} {kind} {CONSTRAINTS[constraint]} {triggers} 0)"
    if attribute.basic_type == "Struct":
        parts = [
            line
            for part in attribute.attributes
            for line in _attribute(part, constraint, transient=transient)
        ]
        yield f"{head}{{"
        yield from _elements(attribute.count, parts)
        yield "}"
        return
    if attribute.count:
        yield f"{head};"  # the parser has no notation for one value of all elements
        return
    value = _initial_value(attribute)
    yield f"{head};" if value is None else f"{head}={value};"


def _initial_value(attribute: DataAttribute) -> str | None:
    """Return the value in the parser's notation.

    It is None for no value, a value not of its type, or one that has no notation.
    """
    text, kind = attribute.value, attribute.basic_type
    if text is None:
        return None
    if kind == "Enum":
        ordinal = attribute.ordinal
        return str(ordinal) if ordinal is not None and abs(ordinal) < 2**31 else None
    if kind == "BOOLEAN":
        return {"true": "1", "1": "1", "false": "0", "0": "0"}.get(text.strip().lower())
    if kind in INTEGER_RANGES:
        return _integer(text, *INTEGER_RANGES[kind])
    if kind in ("FLOAT32", "FLOAT64"):
        return _float(text)
    if kind in STRING_LENGTHS:
        return _string(text, STRING_LENGTHS[kind], ascii_only=kind != "Unicode255")
    return None


def _integer(text: str, lowest: int, highest: int) -> str | None:
    try:
        number = int(text)
    except ValueError:
        return None
    return str(number) if lowest <= number <= highest else None


def _float(text: str) -> str | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return repr(number) if math.isfinite(number) else None


def _string(text: str, longest: int, *, ascii_only: bool) -> str:
    """Return a string without what would end it early.

    VisibleString is ISO 646. The string is cut to its length in bytes.
    """
    clean = "".join("'" if char == '"' else char for char in text.strip() if char.isprintable())
    encoded = clean.encode("ascii", "replace") if ascii_only else clean.encode()
    return f'"{encoded[:longest].decode(errors="ignore").rstrip("{")}"'


def _member(
    ied: Ied, device: LogicalDevice, member: DataSetMember, domains: Mapping[str, str]
) -> Iterator[str]:
    """Yield a data set entry, LN$FC$DO$DA [array element [component]]; one that names no data is left out."""
    if ied.resolve(member) is None:
        return
    names = member.path.split(".")
    node = ied.node_of(member)
    array = None if node is None or member.index is None else node.array_in(member.path)
    depth = len(names) if array is None else array[0]
    words = ["$".join((member.logical_node, member.fc, *names[:depth]))]
    if member.logical_device != device.inst:
        words[0] = f"{domains[member.logical_device]}/{words[0]}"
    if array is not None:
        words += [str(member.index), "$".join(names[depth:])]
    yield f"DE({' '.join(words).rstrip()});"


def _report(report: ReportControl, *, owner: bool) -> Iterator[str]:
    triggers = report.trigger_options.value | (OWNER_SHOWN if owner else 0)
    data_set = "-" if report.data_set is None else report.data_set.name
    for instance in report.instances:
        yield (
            f"RC({instance} {_word(report.report_id)} {int(report.buffered)} {data_set} "
            f"{report.configuration_revision} {triggers} {report.optional_fields.value} "
            f"{report.buffer_time_ms} {report.integrity_period_ms});"
        )


def _log_control(domain: str, node: LogicalNode, log: LogControl) -> str:
    reference = "-" if log.log is None else f"{domain}/{node.name}${log.log}"
    return (
        f"LC({log.name} {log.data_set or '-'} {reference} {log.trigger_options.value} "
        f"{log.integrity_period_ms} {int(log.enabled)} {int(log.reason_code)});"
    )


def _goose(goose: GooseControl) -> Iterator[str]:
    address = goose.address
    times = (None, None) if address is None else (address.minimum_time_ms, address.maximum_time_ms)
    minimum, maximum = (-1 if time is None else time for time in times)
    yield (
        f"GC({goose.name} {_word(goose.application_id)} {goose.data_set or '-'} "
        f"{goose.configuration_revision} {int(goose.fixed_offsets)} {minimum} {maximum} ){{"
    )
    yield from _multicast_address(address)
    yield "}"


def _sampled_values(stream: SampledValueControl) -> Iterator[str]:
    yield (
        f"SMVC({stream.name} {_word(stream.stream_id)} {stream.data_set or '-'} "
        f"{stream.configuration_revision} {stream.sample_mode} {stream.sample_rate} 0 "
        f"{int(not stream.multicast)}){{"
    )
    yield from _multicast_address(stream.address)
    yield "}"


def _multicast_address(address: MulticastAddress | None) -> Iterator[str]:
    if address is not None:
        yield f"PA({address.vlan_priority} {address.vlan_id} {address.application_id} {address.mac.hex()});"


def _word(text: str | None) -> str:
    """Return a free text as one word of the parser; "-", which means none, where it cannot be one."""
    if (
        text is None
        or len(text) > LONGEST_WORD
        or not text.isascii()
        or not text.isprintable()
        or " " in text
    ):
        return "-"
    return text or "-"
