"""What may stand in an SCL file: elements, attributes and their order, as one table.

It joins the tables of IEC 61850-6, editions 1, 2 and 2.1: what any of them allows is allowed, what all of
them require is required. Values that the reader itself makes sense of (numbers, booleans) are not described.

A line is `element: attributes | children`. After an attribute `!` says required. After a child `!` says one,
`+` one or more, `?` at most one. Children stand in the order of the table; those joined by `/` may stand in
any order.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

_TABLE: Final = """
SCL: version revision release | Header! Substation Communication? IED DataTypeTemplates? Line Process
Header: id! version revision toolID nameStructure | Text? History?
History: | Hitem+
Hitem: version! revision! when! who what why |

Substation: name! desc | LNode PowerTransformer GeneralEquipment VoltageLevel+ Function
VoltageLevel: name! desc nomFreq numPhases | LNode PowerTransformer GeneralEquipment Voltage? Bay+ Function
Bay: name! desc | LNode PowerTransformer GeneralEquipment ConductingEquipment ConnectivityNode Function
Voltage: unit! multiplier |
LNode: iedName ldInst prefix lnClass! lnInst lnType desc |
PowerTransformer: name! desc virtual type! | LNode TransformerWinding+ SubEquipment EqFunction
TransformerWinding: name! desc virtual type! |\
 LNode Terminal SubEquipment TapChanger? NeutralPoint? EqFunction
TapChanger: name! desc virtual type! | LNode SubEquipment EqFunction
GeneralEquipment: name! desc virtual type! | LNode EqFunction
ConductingEquipment: name! desc virtual type! | LNode Terminal SubEquipment EqFunction
SubEquipment: name! desc virtual phase | LNode EqFunction
Terminal: name desc connectivityNode! processName substationName voltageLevelName bayName lineName\
 cNodeName! |
NeutralPoint: name desc connectivityNode! processName substationName voltageLevelName bayName lineName\
 cNodeName! |
ConnectivityNode: name! desc pathName! | LNode
Function: name! desc type | LNode SubFunction GeneralEquipment ConductingEquipment
SubFunction: name! desc type | LNode GeneralEquipment ConductingEquipment SubFunction
EqFunction: name! desc type | LNode GeneralEquipment EqSubFunction
EqSubFunction: name! desc type | LNode GeneralEquipment EqSubFunction
Line: name! desc type nomFreq numPhases |\
 LNode GeneralEquipment Function Voltage? ConductingEquipment+ ConnectivityNode
Process: name! desc type | LNode GeneralEquipment Function ConductingEquipment Substation Line Process

Communication: desc | SubNetwork+
SubNetwork: name! desc type | BitRate? ConnectedAP+
BitRate: unit multiplier |
ConnectedAP: iedName! apName! desc redProt | Address? GSE SMV PhysConn
Address: desc | P+
P: type! |
GSE: ldInst! cbName! desc | Address? MinTime? MaxTime?
SMV: ldInst! cbName! desc | Address?
MinTime: unit multiplier |
MaxTime: unit multiplier |
PhysConn: type! desc | P

IED: name! desc type manufacturer configVersion originalSclVersion originalSclRevision originalSclRelease\
 engRight owner | Services? AccessPoint+ KDC
KDC: iedName! apName! |
AccessPoint: name! desc router clock kdc | Server/LN/ServerAt Services? GOOSESecurity SMVSecurity
ServerAt: apName! desc |
GOOSESecurity: name! desc xferNumber serialNumber! | Subject! IssuerName!
SMVSecurity: name! desc xferNumber serialNumber! | Subject! IssuerName!
Subject: commonName! idHierarchy! |
IssuerName: commonName! idHierarchy! |
Server: desc timeout | Authentication! LDevice+ Association
Authentication: none password weak strong certificate |
Association: iedName! ldInst! prefix lnClass! lnInst! kind! associationID desc |
LDevice: inst! ldName desc | LN0! LN AccessControl?
AccessControl: |
LN0: lnType! lnClass! inst! desc | DataSet ReportControl LogControl DOI Inputs? Log GSEControl\
 SampledValueControl SettingControl?
LN: lnType! lnClass! inst! prefix desc | DataSet ReportControl LogControl DOI Inputs? Log
DataSet: name! desc | FCDA+
FCDA: ldInst prefix lnClass lnInst doName daName fc! ix |
ReportControl: name! datSet intgPd rptID confRev! buffered bufTime indexed desc |\
 TrgOps? OptFields! RptEnabled?
TrgOps: dchg qchg dupd period gi |
OptFields: seqNum timeStamp dataSet reasonCode dataRef entryID configRef bufOvfl segmentation |
RptEnabled: max desc | ClientLN
ClientLN: iedName! ldInst! prefix lnClass! lnInst! apRef desc |
LogControl: name! datSet intgPd ldInst prefix lnClass lnInst logName! logEna reasonCode bufTime desc | TrgOps?
Log: name desc |
GSEControl: name! datSet confRev type appID! fixedOffs securityEnable desc | IEDName Protocol?
SampledValueControl: name! datSet confRev smvID! multicast smpRate! nofASDU! smpMod securityEnable desc |\
 IEDName SmvOpts! Protocol?
SmvOpts: refreshTime sampleSynchronized sampleRate dataSet security timestamp synchSourceId dataRef |
IEDName: apRef ldInst prefix lnClass lnInst |
Protocol: mustUnderstand! |
SettingControl: numOfSGs! actSG resvTms desc |
Inputs: desc | ExtRef+
ExtRef: iedName ldInst prefix lnClass lnInst doName daName intAddr serviceType srcLDInst srcPrefix srcLNClass\
 srcLNInst srcCBName pServT pLN pDO pDA desc |
DOI: name! desc ix accessControl | SDI/DAI
SDI: name! desc ix sAddr | SDI/DAI
DAI: name! desc sAddr valKind ix valImport | Val
Val: sGroup |

DataTypeTemplates: | LNodeType+ DOType+ DAType EnumType
LNodeType: id! desc iedType lnClass! | DO+
DO: name! type! desc accessControl transient |
DOType: id! desc iedType cdc! | SDO/DA
SDO: name! type! desc count |
DA: name! bType! fc! desc sAddr valKind type count valImport dchg qchg dupd | Val ProtNs
DAType: id! desc iedType | BDA+ ProtNs
BDA: name! bType! desc sAddr valKind type count valImport | Val
ProtNs: type |
EnumType: id! desc | EnumVal+
EnumVal: ord! desc |
"""

ANYWHERE: Final = ("Text", "Private")
"""Children that every element may have, before all others."""

UNDESCRIBED: Final = frozenset(("Text", "Private", "Services"))
"""Elements whose contents are not checked: text, a vendor's own, and what a relay's tools may do."""


@dataclass(frozen=True, slots=True)
class Rule:
    """What an element may and must have.

    Parameters
    ----------
    attributes : frozenset of str
        Attributes allowed.
    required : tuple of str
        Attributes required.
    order : mapping of str to int
        Place of each child's tag.
    least : tuple of str
        Tags of children required.
    most : frozenset of str
        Tags of children that may stand once only.
    """

    attributes: frozenset[str]
    required: tuple[str, ...]
    order: Mapping[str, int]
    least: tuple[str, ...]
    most: frozenset[str]


def _rule(attributes: str, children: str) -> Rule:
    words = attributes.split()
    order, least, most = dict.fromkeys(ANYWHERE, 0), [], []
    for place, choice in enumerate(children.split(), 1):
        for word in choice.split("/"):
            tag = word.rstrip("!+?")
            order[tag] = place
            if word[-1] in "!+":
                least.append(tag)
            if word[-1] in "!?":
                most.append(tag)
    return Rule(
        attributes=frozenset(word.rstrip("!") for word in words),
        required=tuple(word[:-1] for word in words if word.endswith("!")),
        order=order,
        least=tuple(least),
        most=frozenset(most),
    )


def _rules() -> dict[str, Rule]:
    rules = {}
    for line in filter(None, _TABLE.splitlines()):
        tag, _, rest = line.partition(":")
        attributes, _, children = rest.partition("|")
        rules[tag] = _rule(attributes, children)
    return rules


RULES: Final[Mapping[str, Rule]] = _rules()


@dataclass(frozen=True, slots=True)
class ValueRule:
    """What values an attribute may have.

    Parameters
    ----------
    pattern : re.Pattern
        Pattern that a value matches as a whole.
    expected : str
        The rule in words.
    """

    pattern: re.Pattern[str]
    expected: str


_LN_CLASS = ValueRule(re.compile("[A-Z]{4}|LLN0"), "a class of four capital letters")
_NAME = ValueRule(
    re.compile("[A-Za-z][0-9A-Za-z_]{0,31}"), "a letter and then letters, digits and _, at most 32 in all"
)
_PREFIX = ValueRule(
    re.compile("([A-Za-z][0-9A-Za-z_]{0,10})?"), "a prefix of at most 11 letters, digits and _"
)
_NUMBER = ValueRule(re.compile("[0-9]{0,12}"), "an instance number of at most 12 digits")
_BOOLEAN = ValueRule(re.compile("true|false|1|0"), "true or false")
_ATTRIBUTE = ValueRule(re.compile("[A-Za-z][0-9A-Za-z]{0,59}"), "a name of letters and digits, at most 60")
_ID = ValueRule(re.compile(r"\S{1,255}"), "an id of 1 to 255 characters without blanks")

VALUES: Final[Mapping[tuple[str, str], ValueRule]] = {
    **{(tag, "lnClass"): _LN_CLASS for tag in ("LN", "LN0", "LNodeType", "LNode", "FCDA", "ClientLN")},
    **{(tag, "prefix"): _PREFIX for tag in ("LN", "LNode", "FCDA", "ClientLN")},
    **{(tag, "lnInst"): _NUMBER for tag in ("LNode", "FCDA", "ClientLN")},
    **{
        (tag, "name"): _NAME
        for tag in ("DataSet", "ReportControl", "LogControl", "GSEControl", "SampledValueControl", "Log")
    },
    **{(tag, "name"): _ATTRIBUTE for tag in ("SDO", "DA", "BDA", "SDI", "DAI")},
    **{(tag, "id"): _ID for tag in ("LNodeType", "DOType", "DAType", "EnumType")},
    **{(tag, "valImport"): _BOOLEAN for tag in ("DA", "BDA", "DAI")},
    **{
        (tag, "valKind"): ValueRule(re.compile("Spec|Conf|RO|Set"), "Spec, Conf, RO or Set")
        for tag in ("DA", "BDA", "DAI")
    },
    **{
        (tag, "name"): ValueRule(
            re.compile("[A-Z][0-9A-Za-z]{0,11}"), "a capital and then letters and digits, at most 12 in all"
        )
        for tag in ("DO", "DOI")
    },
    ("LN", "inst"): ValueRule(re.compile("[0-9]{1,12}"), "an instance number of 1 to 12 digits"),
    ("LN0", "inst"): ValueRule(re.compile(""), "empty: there is one LN0 in a logical device"),
    ("IED", "name"): ValueRule(
        re.compile("(?!None$)[A-Za-z][0-9A-Za-z_]{0,63}"), "a letter and then letters, digits and _, not None"
    ),
    ("LDevice", "inst"): ValueRule(
        re.compile("[A-Za-z0-9][0-9A-Za-z_]{0,63}"), "letters, digits and _, at most 64"
    ),
    ("DOType", "cdc"): ValueRule(re.compile("[A-Z][0-9A-Z_a-z]{0,15}"), "a common data class"),
    ("GSEControl", "type"): ValueRule(re.compile("GOOSE|GSSE"), "GOOSE or GSSE"),
    ("SampledValueControl", "smpMod"): ValueRule(
        re.compile("SmpPerPeriod|SmpPerSec|SecPerSmp"), "SmpPerPeriod, SmpPerSec or SecPerSmp"
    ),
    ("Association", "kind"): ValueRule(
        re.compile("pre-established|predefined"), "pre-established or predefined"
    ),
    ("Header", "nameStructure"): ValueRule(re.compile("IEDName|FuncName"), "IEDName"),
}
"""By element and attribute."""
