"""What the relays measure all the time: each quantity's name, unit and place, and its averaging steps."""

from enum import IntEnum, StrEnum
from typing import Self


class MeteredQuantity(StrEnum):
    """A measured value of the motor's terminals: rms of the fundamental, or as the relay defines it.

    The value of a member names the quantity, with its unit, in the database and in the API.

    logical_node: class of the logical nodes that have it. MMXU: measurements; MSTA: statistics of the relay
    itself, since somebody last reset them there.
    data_object: the data object below such a node, and its phase (IEC 61850-7-4). MaxA, MinA, MaxP2PV and
    MinP2PV are an extension of the SEL-700 family.
    """

    logical_node: str
    data_object: str

    IA = "ia_A", "MMXU", "A.phsA"
    IB = "ib_A", "MMXU", "A.phsB"
    IC = "ic_A", "MMXU", "A.phsC"
    VAB = "vab_V", "MMXU", "PPV.phsAB"
    VBC = "vbc_V", "MMXU", "PPV.phsBC"
    VCA = "vca_V", "MMXU", "PPV.phsCA"
    VA = "va_V", "MMXU", "PhV.phsA"
    VB = "vb_V", "MMXU", "PhV.phsB"
    VC = "vc_V", "MMXU", "PhV.phsC"
    POWER = "power_W", "MMXU", "TotW"
    REACTIVE_POWER = "reactive_power_var", "MMXU", "TotVAr"
    POWER_FACTOR = "power_factor", "MMXU", "TotPF"
    FREQUENCY = "frequency_Hz", "MMXU", "Hz"
    AVERAGE_CURRENT = "average_current_A", "MSTA", "AvAmps"
    MAXIMUM_CURRENT = "maximum_current_A", "MSTA", "MaxAmps"
    MINIMUM_CURRENT = "minimum_current_A", "MSTA", "MinAmps"
    AVERAGE_VOLTAGE = "average_voltage_V", "MSTA", "AvVolts"
    MAXIMUM_VOLTAGE = "maximum_voltage_V", "MSTA", "MaxVolts"
    MINIMUM_VOLTAGE = "minimum_voltage_V", "MSTA", "MinVolts"
    AVERAGE_POWER = "average_power_W", "MSTA", "AvW"
    MAXIMUM_POWER = "maximum_power_W", "MSTA", "MaxW"
    MINIMUM_POWER = "minimum_power_W", "MSTA", "MinW"
    MAXIMUM_IA = "maximum_ia_A", "MSTA", "MaxA.phsA"
    MAXIMUM_IB = "maximum_ib_A", "MSTA", "MaxA.phsB"
    MAXIMUM_IC = "maximum_ic_A", "MSTA", "MaxA.phsC"
    MINIMUM_IA = "minimum_ia_A", "MSTA", "MinA.phsA"
    MINIMUM_IB = "minimum_ib_A", "MSTA", "MinA.phsB"
    MINIMUM_IC = "minimum_ic_A", "MSTA", "MinA.phsC"
    MAXIMUM_VAB = "maximum_vab_V", "MSTA", "MaxP2PV.phsAB"
    MAXIMUM_VBC = "maximum_vbc_V", "MSTA", "MaxP2PV.phsBC"
    MAXIMUM_VCA = "maximum_vca_V", "MSTA", "MaxP2PV.phsCA"
    MINIMUM_VAB = "minimum_vab_V", "MSTA", "MinP2PV.phsAB"
    MINIMUM_VBC = "minimum_vbc_V", "MSTA", "MinP2PV.phsBC"
    MINIMUM_VCA = "minimum_vca_V", "MSTA", "MinP2PV.phsCA"

    def __new__(cls, name: str, logical_node: str, data_object: str) -> Self:
        member = str.__new__(cls, name)
        member._value_ = name
        member.logical_node = logical_node
        member.data_object = data_object
        return member

    @property
    def is_statistic(self) -> bool:
        """Tell whether it is the relay's own figure of a long time, which changes slowly."""
        return self.logical_node == "MSTA"

    @property
    def is_maximum(self) -> bool:
        """Tell whether the largest of several values stands for them, not their mean."""
        return self.value.startswith("maximum_")

    @property
    def is_minimum(self) -> bool:
        """Tell whether the smallest of several values stands for them, not their mean."""
        return self.value.startswith("minimum_")


class AveragingStep(IntEnum):
    """Seconds that one item stands for; 0: as sampled."""

    AS_SAMPLED = 0
    MINUTE = 60
    QUARTER_HOUR = 900


class PowerUnit(StrEnum):
    """Unit of the powers P and Q of a relay's load profile; var and kvar are meant, too."""

    W = "W"
    KW = "kW"
