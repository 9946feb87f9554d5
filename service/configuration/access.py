"""Who may use the API, and for how long a login lasts: the table [access] of the settings."""

from ipaddress import IPv4Network, IPv6Network
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, HttpUrl, StringConstraints, field_validator

from service.configuration.relay_access import AbsolutePath

RoleName = Literal["VIEWER", "OPERATOR", "ENGINEER", "SECADM", "SECAUD"]
LOOPBACK = ("localhost", "127.0.0.1", "[::1]")
TokenDays = Annotated[float, Field(ge=0.001, le=3650)]
HeaderName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9-]{0,99}$")]


class ProxySettings(BaseModel):
    """A reverse proxy that knows who asks: [access.proxy].

    addresses: of the proxy, no headers of others count. user_header: has the name of who is logged in there.
    roles_header: has what `roles` translates, with commas between; without it users and their roles are ours.
    sites: what in roles_header gives each site; without it sites are those that the user has here.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    addresses: tuple[IPv4Network | IPv6Network, ...] = Field(min_length=1)
    user_header: HeaderName | None = None
    roles_header: HeaderName | None = None
    roles: dict[RoleName, tuple[str, ...]] = Field(default_factory=dict)
    sites: dict[str, tuple[str, ...]] | None = None


class OidcSettings(BaseModel):
    """An OpenID provider: [access.oidc]. roles: the values of roles_claim that give each role.

    sites: the same for each site; without it sites are those that the user has here.
    confirmation_days: the tokens of somebody count for so long after the provider last let them in.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    issuer: HttpUrl
    client_id: Annotated[str, StringConstraints(min_length=1, max_length=500)]
    client_secret_file: AbsolutePath | None = None
    redirect_url: HttpUrl
    scopes: tuple[str, ...] = ("openid", "profile")
    name_claim: str = "preferred_username"
    roles_claim: str = "roles"
    roles: dict[RoleName, tuple[str, ...]] = Field(default_factory=dict)
    sites: dict[str, tuple[str, ...]] | None = None
    ca: AbsolutePath | None = None
    timeout_s: float = Field(default=5.0, ge=0.1, le=60)
    confirmation_days: float = Field(default=7.0, ge=0.01, le=365)

    @field_validator("issuer", "redirect_url")
    @classmethod
    def _encrypted(cls, address: HttpUrl) -> HttpUrl:
        if address.scheme != "https" and address.host not in LOOPBACK:
            raise ValueError("an https address (http on this machine's own addresses alone)")
        return address


class AccessSettings(BaseModel):
    """How long logins and tokens last, and how many logins may fail in a row.

    sessions: that a user has at a time; those that were used longest ago end.
    token_days: the longest that a token is taken; "unlimited" lets tokens be made that have no end.
    use_notice: shown before a login, which acknowledges it. second_factor_roles: those that need one.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    session_idle_minutes: float = Field(default=60.0, ge=1, le=10_080)
    session_hours: float = Field(default=12.0, ge=0.1, le=744)
    sessions: int = Field(default=100, ge=1, le=1000)
    token_days: TokenDays | Literal["unlimited"] = 90.0
    failed_logins: int = Field(default=5, ge=1, le=1000)
    lockout_minutes: float = Field(default=15.0, ge=1, le=1440)
    use_notice: (
        Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=4000)] | None
    ) = None
    second_factor_roles: frozenset[RoleName] = frozenset()
    proxy: ProxySettings | None = None
    oidc: OidcSettings | None = None
