"""The IED's description (IID or ICD, IEC 61850-6 edition 2): what other systems are engineered with.

The same file makes the model that the server offers, so that both agree.
"""

from collections.abc import Mapping, Sequence
from typing import Final

from lxml import etree
from lxml.builder import ElementMaker

from core.condition.assessment import PHASES

NAMESPACE: Final = "http://www.iec.ch/61850/2003/SCL"
TEMPLATE: Final = "TEMPLATE"
"""Name of the IED in an ICD, which describes what can be had; an IID has the real one."""

CONFIGURATION_REVISION: Final = "3"
"""Of reports (confRev) and logical devices (configRev). Count it up when a data set gets other members."""

ACCESS_POINT: Final = "S1"
DATA_SET: Final = "Verdict"
REPORT: Final = "brcbVerdict"
INSTANCES: Final = 3
"""Clients at a time that may have buffered reports of a motor, each with a control block of its own."""

ANALOGUES: Final = (
    "level of the fault [%]",
    "lower end of its 95 % interval [%]",
    "upper end of its 95 % interval [%]",
    "detection limit of the latest record [%]",
    "load [% of rated]",
    "change of the level since the reference [%]",
    *(f"probability of phase {phase}, if shorted turns [%]" for phase in PHASES),
)
"""What GGIO1.AnIn1 and so on are."""

INTEGERS: Final = ("kind of what stands out, see the documentation", "rotor: 0 none, 1 watch, 2 fault")
"""What GGIO1.IntIn1 and so on are."""

UNBALANCES: Final = ("ImbNgV", "ImbNgA")
"""Of MSQI1: negative over positive sequence of voltage and current [%]."""

_E: Final = ElementMaker(namespace=NAMESPACE, nsmap={None: NAMESPACE})
_TRIGGERS: Final = {"dchg": "true", "qchg": "true", "gi": "true", "period": "true"}
_SHOWN: Final = {
    "seqNum": "true", "timeStamp": "true", "dataSet": "true", "reasonCode": "true", "entryID": "true",
    "configRef": "true", "bufOvfl": "true",
}  # fmt: skip

_OF_MOTOR: Final = (
    ("", "LPHD", "1", ("PhyHealth", "Proxy"), "ST"),
    ("", "ZMOT", "1", ("EEHealth",), "ST"),
    ("", "GAPC", "1", ("Str", "Op"), "ST"),
    ("", "GGIO", "1", tuple(f"IntIn{number}" for number in range(1, len(INTEGERS) + 1)), "ST"),
    ("", "GGIO", "1", tuple(f"AnIn{number}" for number in range(1, len(ANALOGUES) + 1)), "MX"),
    ("", "MSQI", "1", UNBALANCES, "MX"),
)
"""Members of a motor's data set: prefix, class and instance of the node, its objects, and the constraint."""
_OF_PLANT: Final = (("", "CALH", "1", ("GrAlm", "GrWrn"), "ST"),)


def description(
    ied: str, motors: Mapping[str, str], *, plant: str, revision: str, shown: Mapping[str, bool]
) -> bytes:
    """Return the description of an IED of this name.

    motors: descriptions for people, by logical device.  plant: device of the plant.  shown: whether clients
    have to show a `password` and a `certificate`.
    """
    devices = [
        _device(plant, "The plant", _OF_PLANT, ("LPHD", "CALH")),
        *(
            _device(device, text, _OF_MOTOR, ("LPHD", "ZMOT", "GAPC", "GGIO", "MSQI"))
            for device, text in motors.items()
        ),
    ]
    root = _E.SCL(
        _E.Header(id="StatorWatch", version=revision, revision="1", toolID="StatorWatch"),
        _E.IED(
            _E.Services(
                _E.DynAssociation(),
                _E.GetDirectory(),
                _E.GetDataObjectDefinition(),
                _E.DataObjectDirectory(),
                _E.GetDataSetValue(),
                _E.DataSetDirectory(),
                _E.ReadWrite(),
                _E.ConfReportControl(max=str(INSTANCES * len(devices))),
                _E.GetCBValues(),
                _E.ReportSettings(
                    cbName="Fix", datSet="Fix", rptID="Dyn", optFields="Dyn", bufTime="Dyn", trgOps="Dyn",
                    intgPd="Dyn",
                ),
                _E.ConfLNs(),
            ),
            _E.AccessPoint(_E.Server(_authentication(shown), *devices), name=ACCESS_POINT),
            name=ied,
            manufacturer="StatorWatch",
            type="Motor health",
            configVersion=revision,
        ),
        _templates(),
        version="2007",
        revision="B",
        release="4",
    )  # fmt: skip
    return bytes(etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True))


def _authentication(shown: Mapping[str, bool]) -> etree._Element:
    ways = {"none": not any(shown.values()), **shown}
    return _E.Authentication(**{way: str(is_so).lower() for way, is_so in ways.items()})


Members = Sequence[tuple[str, str, str, Sequence[str], str]]


def _device(name: str, text: str, members: Members, nodes: Sequence[str]) -> etree._Element:
    data_set = _E.DataSet(
        *(
            _E.FCDA(
                ldInst=name, prefix=prefix, lnClass=kind, lnInst=number, doName=data_object, fc=constraint
            )
            for prefix, kind, number, objects, constraint in members
            for data_object in objects
        ),
        name=DATA_SET,
    )
    report = _E.ReportControl(
        _E.TrgOps(**_TRIGGERS),
        _E.OptFields(**_SHOWN),
        _E.RptEnabled(max=str(INSTANCES)),
        name=REPORT,
        datSet=DATA_SET,
        confRev=CONFIGURATION_REVISION,
        buffered="true",
        bufTime="100",
        intgPd="0",
        indexed="true",
    )
    return _E.LDevice(
        _E.LN0(data_set, report, lnClass="LLN0", inst="", lnType="LLN0"),
        *(_E.LN(prefix="", lnClass=kind, inst="1", lnType=kind) for kind in nodes),
        inst=name,
        desc=text,
    )


def _templates() -> etree._Element:
    node_types = {
        "LLN0": {"Mod": "Mod", "Beh": "Beh", "Health": "Health", "NamPlt": "NamPlt"},
        "LPHD": {"PhyNam": "PhyNam", "PhyHealth": "Health", "Proxy": "SPS"},
        "ZMOT": {"Beh": "Beh", "EEHealth": "Health"},
        "GAPC": {"Beh": "Beh", "Str": "ACD", "Op": "ACT"},
        "GGIO": {
            "Beh": "Beh",
            **{f"IntIn{number}": "INS" for number in range(1, len(INTEGERS) + 1)},
            **{f"AnIn{number}": "MV" for number in range(1, len(ANALOGUES) + 1)},
        },
        "MSQI": {"Beh": "Beh", **dict.fromkeys(UNBALANCES, "MV")},
        "CALH": {"Beh": "Beh", "GrAlm": "SPS", "GrWrn": "SPS"},
    }
    return _E.DataTypeTemplates(
        *(
            _E.LNodeType(*(_E.DO(name=name, type=of) for name, of in objects.items()), id=kind, lnClass=kind)
            for kind, objects in node_types.items()
        ),
        _object_type("Mod", "ENC", _enumerated("BehaviourModeKind", "on"), _model_of_no_control()),
        _object_type("Beh", "ENS", _enumerated("BehaviourModeKind", "on")),
        _object_type("Health", "ENS", _enumerated("HealthKind", "Ok")),
        _object_type("SPS", "SPS", [_state("stVal", "BOOLEAN")], [_text("d")]),
        _object_type("INS", "INS", [_state("stVal", "INT32")], [_text("d")]),
        _object_type("ACT", "ACT", [_state(name, "BOOLEAN") for name in ("general", "phsA", "phsB", "phsC")]),
        _object_type("ACD", "ACD", _directed()),
        _E.DOType(
            _E.DA(name="mag", fc="MX", dchg="true", bType="Struct", type="Magnitude"),
            _E.DA(name="q", fc="MX", qchg="true", bType="Quality"),
            _E.DA(name="t", fc="MX", bType="Timestamp"),
            _text("d"),
            id="MV",
            cdc="MV",
        ),
        _E.DOType(*(_text(name) for name in ("vendor", "swRev", "d", "configRev")), id="NamPlt", cdc="LPL"),
        _E.DOType(*(_text(name) for name in ("vendor", "model", "name")), id="PhyNam", cdc="DPL"),
        _E.DAType(_E.BDA(name="f", bType="FLOAT32"), id="Magnitude"),
        _enumeration("BehaviourModeKind", {1: "on", 2: "on-blocked", 3: "test", 4: "test/blocked", 5: "off"}),
        _enumeration("HealthKind", {1: "Ok", 2: "Warning", 3: "Alarm"}),
        _enumeration("FaultDirectionKind", {0: "unknown", 1: "forward", 2: "backward", 3: "both"}),
        _enumeration("PhaseFaultDirectionKind", {0: "unknown", 1: "forward", 2: "backward"}),
        _enumeration("CtlModelKind", {0: "status-only"}),
    )


def _object_type(name: str, common_class: str, *attributes: Sequence[etree._Element]) -> etree._Element:
    states, *others = attributes
    return _E.DOType(
        *states,
        _E.DA(name="q", fc="ST", qchg="true", bType="Quality"),
        _E.DA(name="t", fc="ST", bType="Timestamp"),
        *(one for attribute in others for one in attribute),
        id=name,
        cdc=common_class,
    )


def _state(name: str, kind: str) -> etree._Element:
    return _E.DA(name=name, fc="ST", dchg="true", bType=kind)


def _enumerated(kind: str, value: str) -> list[etree._Element]:
    return [_E.DA(_E.Val(value), name="stVal", fc="ST", dchg="true", bType="Enum", type=kind)]


def _model_of_no_control() -> list[etree._Element]:
    return [_E.DA(_E.Val("status-only"), name="ctlModel", fc="CF", bType="Enum", type="CtlModelKind")]


def _directed() -> list[etree._Element]:
    attributes = []
    for name, direction, kind in (
        ("general", "dirGeneral", "FaultDirectionKind"),
        *((f"phs{phase}", f"dirPhs{phase}", "PhaseFaultDirectionKind") for phase in "ABC"),
    ):
        attributes += [
            _state(name, "BOOLEAN"),
            _E.DA(name=direction, fc="ST", dchg="true", bType="Enum", type=kind),
        ]
    return attributes


def _text(name: str) -> etree._Element:
    return _E.DA(name=name, fc="DC", bType="VisString255")


def _enumeration(name: str, values: Mapping[int, str]) -> etree._Element:
    return _E.EnumType(*(_E.EnumVal(text, ord=str(number)) for number, text in values.items()), id=name)
