"""Data sets and control blocks of a logical node (IEC 61850-7-2 clauses 13 to 19)."""

from dataclasses import dataclass
from enum import Flag

from scl.data_model import FunctionalConstraint, TriggerOptions


class OptionalFields(Flag):
    """What a report carries besides the values (IEC 61850-7-2, OptFlds)."""

    NONE = 0
    SEQUENCE_NUMBER = 1
    TIME_STAMP = 2
    REASON_CODE = 4
    DATA_SET = 8
    DATA_REFERENCE = 16
    BUFFER_OVERFLOW = 32
    ENTRY_ID = 64
    CONFIGURATION_REVISION = 128


@dataclass(frozen=True, slots=True)
class DataSetMember:
    """A member of a data set (FCDA).

    Parameters
    ----------
    reference : str
        Full reference of the object or attribute.
    fc : FunctionalConstraint
        Its functional constraint.
    logical_device : str
        The inst of its logical device.
    logical_node : str
        Name of its logical node.
    path : str
        Path below the logical node, without array index.
    index : int or None
        Array element; None for none.
    """

    reference: str
    fc: FunctionalConstraint
    logical_device: str
    logical_node: str
    path: str
    index: int | None = None

    def covers(self, reference: str) -> bool:
        """Tell whether a report of this member carries a referenced object, or part of it.

        Parameters
        ----------
        reference : str
            Full reference of the object or attribute.

        Returns
        -------
        bool
            True if it does.
        """
        return f"{self.reference}.".startswith(f"{reference}.") or f"{reference}.".startswith(
            f"{self.reference}."
        )


@dataclass(frozen=True, slots=True)
class DataSet:
    """An ordered list of members.

    Parameters
    ----------
    name : str
        Name of the data set.
    reference : str
        Reference such as "A1_SEL710CFG/LLN0.DSet01".
    members : tuple of DataSetMember
        The members in order.
    """

    name: str
    reference: str
    members: tuple[DataSetMember, ...]

    def covers(self, reference: str) -> bool:
        """Tell whether a member carries a referenced object, or part of it.

        Parameters
        ----------
        reference : str
            Full reference of the object or attribute.

        Returns
        -------
        bool
            True if one does.
        """
        return any(member.covers(reference) for member in self.members)


@dataclass(frozen=True, slots=True)
class ReportControl:
    """A report control: one SCL element for one or more control blocks, each for one client at a time.

    Parameters
    ----------
    name : str
        Name of the report control.
    references : tuple of str
        References of the control blocks as clients address them ("A1_SEL710CFG/LLN0.BR.BRep01").
    buffered : bool
        Whether the blocks buffer reports while no client has them.
    data_set : DataSet or None
        The data set that is reported.
    report_id : str or None
        RptID.
    configuration_revision : int
        ConfRev.
    trigger_options : TriggerOptions
        What makes a report.
    optional_fields : OptionalFields
        What a report carries besides the values.
    buffer_time_ms : int
        Time in which changes are collected into one report [ms].
    integrity_period_ms : int
        Period of reports of all members [ms]; 0 for none.

    References
    ----------
    IEC 61850-7-2 clause 17; IEC 61850-6 clause 9.3.8.
    """

    name: str
    references: tuple[str, ...]
    buffered: bool
    data_set: DataSet | None
    report_id: str | None
    configuration_revision: int
    trigger_options: TriggerOptions
    optional_fields: OptionalFields
    buffer_time_ms: int
    integrity_period_ms: int

    @property
    def instances(self) -> tuple[str, ...]:
        """Names of the control blocks: the name itself, or with the numbers of an indexed one."""
        return tuple(reference.rpartition(".")[2] for reference in self.references)


@dataclass(frozen=True, slots=True)
class LogControl:
    """A log control block.

    Parameters
    ----------
    name : str
        Name of the block.
    data_set : str or None
        Name of the data set that is logged.
    log : str or None
        Name of the log.
    trigger_options : TriggerOptions
        What makes an entry.
    integrity_period_ms : int
        Period of entries of all members [ms]; 0 for none.
    enabled : bool
        Whether logging is on at first.
    reason_code : bool
        Whether entries carry the reason.
    """

    name: str
    data_set: str | None
    log: str | None
    trigger_options: TriggerOptions
    integrity_period_ms: int
    enabled: bool
    reason_code: bool


@dataclass(frozen=True, slots=True)
class MulticastAddress:
    """Multicast address of a GOOSE or sampled value control block.

    Parameters
    ----------
    mac : bytes
        Six octets of the MAC address.
    application_id : int
        APPID.
    vlan_id : int
        Virtual LAN.
    vlan_priority : int
        Priority in the virtual LAN, 0 to 7.
    minimum_time_ms : int or None
        Shortest time between retransmissions [ms]; None where the file gives none.
    maximum_time_ms : int or None
        Longest time between retransmissions [ms]; None where the file gives none.
    """

    mac: bytes
    application_id: int
    vlan_id: int
    vlan_priority: int
    minimum_time_ms: int | None = None
    maximum_time_ms: int | None = None


@dataclass(frozen=True, slots=True)
class GooseControl:
    """A GOOSE control block.

    Parameters
    ----------
    name : str
        Name of the block.
    application_id : str
        Identification of the application, appID.
    data_set : str or None
        Name of the data set that is sent.
    configuration_revision : int
        ConfRev.
    fixed_offsets : bool
        Whether the encoding has fixed offsets.
    address : MulticastAddress or None
        Where it is sent; None where the communication section has no address.
    """

    name: str
    application_id: str
    data_set: str | None
    configuration_revision: int
    fixed_offsets: bool
    address: MulticastAddress | None = None


@dataclass(frozen=True, slots=True)
class SampledValueControl:
    """A sampled value control block.

    Parameters
    ----------
    name : str
        Name of the block.
    stream_id : str
        Identification of the stream, smvID.
    data_set : str or None
        Name of the data set that is sent.
    configuration_revision : int
        ConfRev.
    sample_mode : int
        What the sample rate counts: 0 samples a period, 1 samples a second, 2 seconds a sample.
    sample_rate : int
        Sample rate in the unit of the mode.
    multicast : bool
        Whether the stream is multicast.
    address : MulticastAddress or None
        Where it is sent; None where the communication section has no address.
    """

    name: str
    stream_id: str
    data_set: str | None
    configuration_revision: int
    sample_mode: int
    sample_rate: int
    multicast: bool
    address: MulticastAddress | None = None


@dataclass(frozen=True, slots=True)
class SettingGroups:
    """Setting groups of a logical device.

    Parameters
    ----------
    number : int
        Number of groups.
    active : int
        The active group, from 1.
    """

    number: int
    active: int
