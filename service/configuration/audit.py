"""Where the audit trail goes besides the database: the table [audit] of the settings."""

from typing import Literal

from pydantic import BaseModel, ConfigDict

from service.configuration.channels import Facility, SyslogChannel


class AuditSyslog(SyslogChannel):
    """The syslog server that gets every entry, each with its number and its hash."""

    kind: Literal["syslog"] = "syslog"
    facility: Facility = "audit"


class AuditSettings(BaseModel):
    """syslog: None sends the entries nowhere."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    syslog: AuditSyslog | None = None
