"""A small relay as model text: every attribute type and control model, data sets, report control blocks."""

from typing import Final

IED: Final = "T1"

# DataAttributeType, FunctionalConstraint and trigger numbers of the library's text format.
_BOOLEAN, _INT32, _INT8U, _INT32U, _ENUM, _OCTETS, _VISIBLE_129, _TIME, _QUALITY, _CHECK, _STRUCT = (
    0, 3, 6, 9, 12, 13, 19, 22, 23, 24, 27,
)  # fmt: skip
_ST, _MX, _SP, _CF, _DC, _CO = 0, 1, 2, 4, 5, 12
_DATA_CHANGE, _QUALITY_CHANGE = 1, 2
_TRIGGERS: Final = 1 | 2 | 16  # dchg, qchg, gi

TYPES: Final = {
    "bool": 0, "int8": 1, "int16": 2, "int32": 3, "int64": 4, "uint8": 6, "uint16": 7, "uint24": 8,
    "uint32": 9, "float32": 10, "float64": 11, "enum": 12, "octets64": 13, "octets6": 14, "octets8": 15,
    "visible32": 16, "visible64": 17, "visible65": 18, "visible129": 19, "visible255": 20, "unicode255": 21,
    "time": 22, "quality": 23, "dbpos": 25, "entryTime": 28,
}  # fmt: skip


def _attribute(name: str, kind: int, constraint: int, triggers: int = 0, initial: str = "") -> str:
    return f"DA({name} 0 {kind} {constraint} {triggers} 0){initial};"


def _status(name: str) -> list[str]:
    return [
        f"DO({name} 0){{",
        _attribute("stVal", _BOOLEAN, _ST, _DATA_CHANGE),
        _attribute("q", _QUALITY, _ST, _QUALITY_CHANGE),
        _attribute("t", _TIME, _ST),
        "}",
    ]


def _command(name: str, *, cancel: bool = False) -> list[str]:
    check = [] if cancel else [_attribute("Check", _CHECK, _CO)]
    return [
        f"DA({name} 0 {_STRUCT} {_CO} 0 0){{",
        _attribute("ctlVal", _BOOLEAN, _CO),
        f"DA(origin 0 {_STRUCT} {_CO} 0 0){{",
        _attribute("orCat", _ENUM, _CO),
        _attribute("orIdent", _OCTETS, _CO),
        "}",
        _attribute("ctlNum", _INT8U, _CO),
        _attribute("T", _TIME, _CO),
        _attribute("Test", _BOOLEAN, _CO),
        *check,
        "}",
    ]


def _controllable(name: str, control_model: int) -> list[str]:
    return [
        f"DO({name} 0){{",
        *([_attribute("SBO", _VISIBLE_129, _CO)] if control_model == 2 else []),
        *(_command("SBOw") if control_model == 4 else []),
        *(_command("Oper") if control_model else []),
        *(_command("Cancel", cancel=True) if control_model in (2, 4) else []),
        _attribute("stVal", _BOOLEAN, _ST, _DATA_CHANGE),
        _attribute("q", _QUALITY, _ST, _QUALITY_CHANGE),
        _attribute("t", _TIME, _ST),
        _attribute("ctlModel", _ENUM, _CF, 0, f"={control_model}"),
        *([_attribute("sboTimeout", _INT32U, _CF, 0, "=3000")] if control_model in (2, 4) else []),
        "}",
    ]


def _report(name: str, report_id: str, *, buffered: bool, options: int, buffer_ms: int = 0) -> str:
    return f"RC({name} {report_id} {int(buffered)} DSet01 1 {_TRIGGERS} {options} {buffer_ms} 0);"


_SEQUENCE_AND_REASON: Final = 1 | 4  # no entryID, no bufOvfl: the client has to ask for them
_ALL_OPTIONS: Final = 255

MODEL_TEXT: Final = "\n".join(
    [
        f"MODEL({IED}){{",
        "LD(PRO){",
        "LN(LLN0){",
        *_status("Beh"),
        "DS(DSet01){",
        *[f"DE(GGIO1$ST$Ind{number:02d});" for number in range(1, 5)],
        "}",
        "DS(DSet02){",
        "DE(GGIO1$ST$Ind01$stVal);",
        "DE(PRO/GGIO1$MX$AnIn1);",
        "}",
        _report("BRep01", "BRep01", buffered=True, options=_SEQUENCE_AND_REASON),
        _report("BRep02", "-", buffered=True, options=_ALL_OPTIONS),
        _report("URep01", "URep01", buffered=False, options=_SEQUENCE_AND_REASON),
        _report("Twin01", "twin", buffered=False, options=_ALL_OPTIONS),
        _report("Twin02", "twin", buffered=False, options=_ALL_OPTIONS),
        "}",
        "LN(GGIO1){",
        *[line for number in range(1, 5) for line in _status(f"Ind{number:02d}")],
        "DO(AnIn1 0){",
        f"DA(mag 0 {_STRUCT} {_MX} {_DATA_CHANGE} 0){{",
        _attribute("f", 10, _MX, _DATA_CHANGE),
        "}",
        _attribute("q", _QUALITY, _MX, _QUALITY_CHANGE),
        _attribute("t", _TIME, _MX),
        "}",
        "DO(Types 0){",
        *[_attribute(name, kind, _ST) for name, kind in TYPES.items()],
        "}",
        "DO(Setting 0){",
        _attribute("setVal", _INT32, _SP, 0, "=7"),
        "}",
        "DO(NamPlt 0){",
        _attribute("d", 20, _DC, 0, '="Feeder 1"'),
        "}",
        "}",
        "}",
        "LD(CON){",
        "LN(LLN0){",
        *_status("Beh"),
        "}",
        "LN(RBGGIO1){",
        *[
            line
            for control_model in range(5)
            for line in _controllable(f"SPCSO{control_model:02d}", control_model)
        ],
        "}",
        "}",
        "}",
        "",
    ]
)
