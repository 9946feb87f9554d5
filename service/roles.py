"""The roles of people and programs. Commands know them without loading what is behind a role."""

from enum import StrEnum


class Role(StrEnum):
    """What somebody is in the plant, after IEC 62351-8. A person may have several."""

    VIEWER = "VIEWER"
    OPERATOR = "OPERATOR"
    ENGINEER = "ENGINEER"
    SECADM = "SECADM"
    SECAUD = "SECAUD"
