"""The channels through which people and programs are told: tables [notifications.channels.NAME].

They hold no secrets: passwords, signing keys and addresses that are secret are in files or in the environment
(`channel_secrets`), and are read when something is sent.
"""

import re
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints, model_validator

from service.configuration.relay_access import AbsolutePath

CHANNEL_PATHS = ("password_file", "secret_file", "url_file", "urls_file", "ca", "certificate", "key")
"""Keys of a channel that are paths."""

LONGEST_TIMEOUT_S = 300.0

_FACILITIES = (
    "kern user mail daemon auth syslog lpr news uucp cron authpriv ftp ntp audit alert clock "
    "local0 local1 local2 local3 local4 local5 local6 local7"
)
FACILITIES = {name: number for number, name in enumerate(_FACILITIES.split())}
"""Facilities of syslog (RFC 5424, table 1)."""

SYSLOG_PORTS = {"udp": 514, "tcp": 601, "tls": 6514}
MAIL_PORTS = {"starttls": 587, "tls": 465, "none": 25}


def _host(text: str) -> str:
    if re.fullmatch(r"[A-Za-z0-9._:-]{1,253}", text) is None:
        raise ValueError("the name or the address of a host, without a port")
    return text


def _mail_address(text: str) -> str:
    if re.fullmatch(r"[A-Za-z0-9.!#$%&'*+/=?^_`{|}~-]{1,64}@[A-Za-z0-9-]+(\.[A-Za-z0-9-]+)*", text) is None:
        raise ValueError("a mail address such as shift@plant.example, without a name and in ASCII")
    return text


def _url(text: str) -> str:
    if re.fullmatch(r"https?://[^\s/@?#\\]+(/[^\s#\\]*)?(\?[^\s#\\]*)?", text) is None or not text.isascii():
        # What was found may hold a password.
        raise ValueError(
            "an address such as https://chat.plant.example/hook, without a password, found another text"
        )
    return text


def _facility(name: str) -> str:
    if name not in FACILITIES:
        raise ValueError(f"one of {', '.join(FACILITIES)}")
    return name


def _program(words: tuple[str, ...]) -> tuple[str, ...]:
    if not words[0].startswith("/") or any("\0" in word for word in words):
        raise ValueError(
            'a list of words that begins with the path of a program, such as ["/opt/page", "-v"]'
        )
    return words


ChannelName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,49}$")]
Host = Annotated[str, AfterValidator(_host)]
MailAddress = Annotated[str, Field(max_length=254), AfterValidator(_mail_address)]
Url = Annotated[str, Field(max_length=2000), AfterValidator(_url)]
Facility = Annotated[str, AfterValidator(_facility)]
Port = Annotated[int, Field(ge=1, le=65535)]


class _Channel(BaseModel):
    """timeout_s: for one attempt as a whole."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, populate_by_name=True)

    timeout_s: float = Field(default=30.0, ge=0.1, le=LONGEST_TIMEOUT_S)


class MailChannel(_Channel):
    """Mail through a server that takes it (SMTP). Each address gets a mail of its own."""

    kind: Literal["mail"]
    host: Host
    port: Port | None = None
    security: Literal["starttls", "tls", "none"] = "starttls"
    user: str | None = Field(default=None, max_length=200)
    password_file: AbsolutePath | None = None
    ca: AbsolutePath | None = None
    sender: MailAddress = Field(alias="from")
    to: tuple[MailAddress, ...] = Field(min_length=1, max_length=100)

    @property
    def server_port(self) -> int:
        """Return the port, which follows from `security` where it is not given."""
        return self.port or MAIL_PORTS[self.security]


class WebhookChannel(_Channel):
    """A document posted to an address; `slack` and `teams` are what those take."""

    kind: Literal["webhook"]
    url: Url | None = None
    url_file: AbsolutePath | None = None
    format: Literal["standard", "slack", "teams"] = "standard"
    secret_file: AbsolutePath | None = None
    ca: AbsolutePath | None = None

    @model_validator(mode="after")
    def _one_address(self) -> Self:
        if self.url is not None and self.url_file is not None:
            raise ValueError("one of url and url_file, found both")
        return self


class SyslogChannel(_Channel):
    """A line for a syslog server (RFC 5424)."""

    kind: Literal["syslog"]
    host: Host
    port: Port | None = None
    transport: Literal["udp", "tcp", "tls"] = "tls"
    facility: Facility = "local0"
    framing: Literal["octet-counting", "newline"] = "octet-counting"
    ca: AbsolutePath | None = None
    certificate: AbsolutePath | None = None
    key: AbsolutePath | None = None

    @property
    def server_port(self) -> int:
        """Return the port, which follows from `transport` where it is not given."""
        return self.port or SYSLOG_PORTS[self.transport]

    @model_validator(mode="after")
    def _key_and_certificate(self) -> Self:
        if (self.certificate is None) != (self.key is None):
            raise ValueError("certificate and key together, found one alone")
        if self.transport != "tls" and (self.certificate or self.ca):
            raise ValueError('ca, certificate and key only with transport = "tls"')
        return self


class CommandChannel(_Channel):
    """A program of this machine, run without a shell; it gets the message on its standard input."""

    kind: Literal["command"]
    command: Annotated[tuple[str, ...], Field(min_length=1, max_length=100), AfterValidator(_program)]


class AppriseChannel(_Channel):
    """Addresses of Apprise, one a line of a file, for what the others do not reach."""

    kind: Literal["apprise"]
    urls_file: AbsolutePath | None = None


Channel = Annotated[
    MailChannel | WebhookChannel | SyslogChannel | CommandChannel | AppriseChannel,
    Field(discriminator="kind"),
]


def variable_part(name: str) -> str:
    """Return how a channel is called in variables of the environment."""
    return name.upper().replace("-", "_")
