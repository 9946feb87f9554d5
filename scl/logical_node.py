"""A logical node with its data and its control blocks (IEC 61850-7-2)."""

from dataclasses import dataclass

from scl.control_block_model import (
    DataSet,
    DataSetMember,
    GooseControl,
    LogControl,
    ReportControl,
    SampledValueControl,
    SettingGroups,
)
from scl.data_model import DataAttribute, DataObject, FunctionalConstraint


@dataclass(frozen=True, slots=True)
class LogicalNode:
    """A logical node with its data and control blocks.

    Parameters
    ----------
    reference : str
        Reference such as "A1_SEL710PRO/FLTRDRE1".
    prefix : str
        Prefix of the name.
    ln_class : str
        Class, such as "RDRE".
    inst : str
        Instance number.
    description : str
        Description for people.
    data_objects : tuple of DataObject
        Its data objects.
    data_sets : tuple of DataSet
        Its data sets.
    report_controls : tuple of ReportControl
        Its report controls.
    log_controls : tuple of LogControl
        Its log controls.
    logs : tuple of str
        Names of its logs.
    goose_controls : tuple of GooseControl
        Its GOOSE controls.
    sampled_value_controls : tuple of SampledValueControl
        Its sampled value controls.
    setting_groups : SettingGroups or None
        The setting groups, of LLN0 only.
    """

    reference: str
    prefix: str
    ln_class: str
    inst: str
    description: str
    data_objects: tuple[DataObject, ...]
    data_sets: tuple[DataSet, ...] = ()
    report_controls: tuple[ReportControl, ...] = ()
    log_controls: tuple[LogControl, ...] = ()
    logs: tuple[str, ...] = ()
    goose_controls: tuple[GooseControl, ...] = ()
    sampled_value_controls: tuple[SampledValueControl, ...] = ()
    setting_groups: SettingGroups | None = None

    @property
    def name(self) -> str:
        """Name of the node: prefix, class and instance number."""
        return f"{self.prefix}{self.ln_class}{self.inst}"

    def find(self, path: str) -> DataObject | DataAttribute | None:
        """Find a data object or attribute below the node.

        Parameters
        ----------
        path : str
            Path such as "A.phsA.cVal.mag.f".

        Returns
        -------
        DataObject or DataAttribute or None
            What was found; None where there is nothing.
        """
        name, _, rest = path.partition(".")
        found = next((child for child in self.data_objects if child.name == name), None)
        return found.find(rest) if found is not None and rest else found

    def holds(self, path: str, constraint: FunctionalConstraint) -> bool:
        """Tell whether there is data of a constraint at a path below the node.

        Parameters
        ----------
        path : str
            Path such as "A.phsA".
        constraint : FunctionalConstraint
            Functional constraint of the data.

        Returns
        -------
        bool
            True if there is.
        """
        return _has(self.find(path), constraint)

    def offers(self, member: DataSetMember) -> bool:
        """Tell whether the node has what a data set member names.

        Parameters
        ----------
        member : DataSetMember
            A member with data of this node.

        Returns
        -------
        bool
            False where the node has no such data of the constraint, or no such element of an array.
        """
        array = self.array_in(member.path)
        return self.holds(member.path, member.fc) and (array is None or _is_in_array(member, *array))

    def array_in(self, path: str) -> tuple[int, int] | None:
        """Find the first array on a path below the node.

        Parameters
        ----------
        path : str
            Path such as "HA.phsAHar.cVal".

        Returns
        -------
        tuple of int and int or None
            Number of names down to the array, and of its elements; None where there is no array.
        """
        names = path.split(".")
        found = self.find(names[0])
        for depth, name in enumerate(names[1:], 2):
            if isinstance(found, DataObject):
                found = found.find(name)
            elif found is not None:
                found = next((each for each in found.attributes if each.name == name), None)
            if found is not None and found.count:
                return depth, found.count
        return None


def _is_in_array(member: DataSetMember, depth: int, count: int) -> bool:
    """Tell whether a member names an array, or with its index an element of it or a part of one."""
    if member.index is None:
        return depth == len(member.path.split("."))
    return member.index < count


def _has(found: DataObject | DataAttribute | None, constraint: FunctionalConstraint) -> bool:
    """Tell whether what was found has data of a constraint; an editable setting also counts as active."""
    constraints = found.constraints() if isinstance(found, DataObject) else {found.fc} if found else set()
    editable = constraint is FunctionalConstraint.SG and FunctionalConstraint.SE in constraints
    return constraint in constraints or editable
