"""Data objects and attributes of an IED's data model (IEC 61850-7-2, -7-3).

References are written as in IEC 61850-8-1 clause 7: domain/LogicalNode.DataObject.attribute. Types are
resolved: a data object carries its attributes and their initial values, instance values over type defaults.
"""

import re
from dataclasses import dataclass, field
from enum import Flag, StrEnum

CONTROL_MODELS = (
    "status-only",
    "direct-with-normal-security",
    "sbo-with-normal-security",
    "direct-with-enhanced-security",
    "sbo-with-enhanced-security",
)


class FunctionalConstraint(StrEnum):
    """Functional constraints of IEC 61850-7-2 table 18 that data attributes can have."""

    ST = "ST"
    MX = "MX"
    SP = "SP"
    SV = "SV"
    CF = "CF"
    DC = "DC"
    SG = "SG"
    SE = "SE"
    SR = "SR"
    OR = "OR"
    BL = "BL"
    EX = "EX"
    CO = "CO"


class TriggerOptions(Flag):
    """What makes a report or log entry (IEC 61850-7-2, TriggerConditions)."""

    NONE = 0
    DATA_CHANGE = 1
    QUALITY_CHANGE = 2
    DATA_UPDATE = 4
    INTEGRITY = 8
    GENERAL_INTERROGATION = 16


@dataclass(frozen=True, slots=True)
class Enumeration:
    """An EnumType: names by ordinal.

    Parameters
    ----------
    id : str
        The type's id.
    literals : tuple of tuple of int and str
        Ordinals and names.
    """

    id: str
    literals: tuple[tuple[int, str], ...]

    def ordinal(self, text: str) -> int | None:
        """Find the ordinal of a literal, or of an ordinal written as a number.

        Parameters
        ----------
        text : str
            The literal or number.

        Returns
        -------
        int or None
            The ordinal; None if the text is neither.
        """
        for number, literal in self.literals:
            if literal == text:
                return number
        return int(text) if re.fullmatch(r"[+-]?[0-9]{1,10}", text) else None


@dataclass(frozen=True, slots=True)
class DataAttribute:
    """A data attribute with its functional constraint.

    Parameters
    ----------
    name : str
        Name of the attribute.
    fc : FunctionalConstraint
        Its functional constraint.
    basic_type : str
        The SCL's bType ("BOOLEAN", "FLOAT32", "Enum", "Struct" and so on).
    trigger_options : TriggerOptions
        Changes that make a report.
    value : str or None
        Initial value as written in the file; None where the file gives none.
    enumeration : Enumeration or None
        Type of an Enum.
    attributes : tuple of DataAttribute
        Components of a Struct.
    count : int
        Number of array elements, 0 for no array.
    """

    name: str
    fc: FunctionalConstraint
    basic_type: str
    trigger_options: TriggerOptions = TriggerOptions.NONE
    value: str | None = None
    enumeration: Enumeration | None = None
    attributes: tuple["DataAttribute", ...] = ()
    count: int = 0

    @property
    def ordinal(self) -> int | None:
        """Ordinal of an enumeration's initial value; None where there is none."""
        if self.enumeration is None or self.value is None:
            return None
        return self.enumeration.ordinal(self.value)


@dataclass(frozen=True, slots=True)
class DataObject:
    """A data object of a common data class.

    Parameters
    ----------
    name : str
        Name of the object.
    common_data_class : str
        Its CDC, such as "SPC".
    objects : tuple of DataObject
        Sub data objects, such as phsA of a WYE.
    attributes : tuple of DataAttribute
        Its attributes.
    count : int
        Number of array elements, 0 for no array.
    transient : bool
        Whether the object is transient: it falls back by itself.
    """

    name: str
    common_data_class: str
    objects: tuple["DataObject", ...] = ()
    attributes: tuple[DataAttribute, ...] = ()
    count: int = 0
    transient: bool = False
    _constraints: frozenset[FunctionalConstraint] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        # Types share their objects, so this costs little. To collect them at each question would cost much.
        below = [child.constraints() for child in self.objects]
        own = frozenset([attribute.fc for attribute in self.attributes])
        object.__setattr__(self, "_constraints", own.union(*below))

    def find(self, path: str) -> "DataObject | DataAttribute | None":
        """Find a sub object or attribute below this object.

        Parameters
        ----------
        path : str
            Path such as "phsA.cVal.mag.f".

        Returns
        -------
        DataObject or DataAttribute or None
            What was found; None where there is nothing.
        """
        node: DataObject | DataAttribute | None = self
        for name in path.split("."):
            if node is None:
                return None
            children: tuple[DataObject | DataAttribute, ...] = node.attributes
            if isinstance(node, DataObject):
                children += node.objects
            node = next((child for child in children if child.name == name), None)
        return node

    @property
    def control_model(self) -> str | None:
        """Initial ctlModel, one of CONTROL_MODELS; None where the file gives none."""
        model = self.find("ctlModel")
        ordinal = model.ordinal if isinstance(model, DataAttribute) else None
        return CONTROL_MODELS[ordinal] if ordinal is not None and ordinal in range(5) else None

    def constraints(self) -> frozenset[FunctionalConstraint]:
        """Tell the functional constraints that occur anywhere in the object.

        Returns
        -------
        frozenset of FunctionalConstraint
            The constraints.
        """
        return self._constraints
