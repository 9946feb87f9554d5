"""GOOSE control blocks of an IED with the data that they send."""

from dataclasses import dataclass

from scl.control_block_model import DataSetMember, GooseControl
from scl.data_model import DataAttribute, DataObject
from scl.ied_model import Ied


@dataclass(frozen=True, slots=True)
class GooseMember:
    """A member of a GOOSE data set.

    Parameters
    ----------
    member : DataSetMember
        The member.
    data : DataObject or DataAttribute or None
        What it names; None where the IED has no such data.
    ln_class : str or None
        Class of its logical node, "PTRC"; None where the IED has no such node.
    """

    member: DataSetMember
    data: DataObject | DataAttribute | None
    ln_class: str | None


@dataclass(frozen=True, slots=True)
class GooseBlock:
    """A GOOSE control block that sends a data set.

    Parameters
    ----------
    reference : str
        Reference in messages, "A1_SEL710CFG/LLN0$GO$GPub01".
    data_set : str
        Reference of its data set in messages, "A1_SEL710CFG/LLN0$DSet04".
    control : GooseControl
        The block as the file has it.
    members : tuple of GooseMember
        Members of the data set, in its order.
    """

    reference: str
    data_set: str
    control: GooseControl
    members: tuple[GooseMember, ...]


def goose_blocks(ied: Ied) -> tuple[GooseBlock, ...]:
    """List the GOOSE control blocks of an IED that send a data set.

    Parameters
    ----------
    ied : Ied
        The IED.

    Returns
    -------
    tuple of GooseBlock
        The blocks in file order; those whose data set is not named, or not there, are left out.

    References
    ----------
    IEC 61850-8-1 clause 18, annex A: how blocks and data sets are named in messages.
    """
    found = []
    for device in ied.logical_devices:
        for node in device.logical_nodes:
            data_sets = {data_set.name: data_set for data_set in node.data_sets}
            for control in node.goose_controls:
                data_set = data_sets.get(control.data_set or "")
                if data_set is not None:
                    place = f"{device.name}/{node.name}"
                    members = tuple(_member(ied, one) for one in data_set.members)
                    found.append(
                        GooseBlock(f"{place}$GO${control.name}", f"{place}${data_set.name}", control, members)
                    )
    return tuple(found)


def _member(ied: Ied, member: DataSetMember) -> GooseMember:
    node = ied.node_of(member)
    return GooseMember(member, ied.resolve(member), None if node is None else node.ln_class)
