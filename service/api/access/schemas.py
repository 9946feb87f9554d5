"""Users, sessions and tokens in the API. No answer has a password or a hash; one has a new token."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StringConstraints, model_validator

from service.access.passkeys import LONGEST_ANSWER, MOST_PASSKEYS
from service.access.permissions import Permission
from service.access.second_factors import CODES
from service.access.user_names import NAME_RULE, name_of
from service.api.document import Document, Listed, Person, RequestDocument
from service.api.times import Time, TimeParameter
from service.storage.records import Role


def _name(value: object) -> object:
    if not isinstance(value, str):
        return value
    name = name_of(value)
    if name is None:
        raise ValueError(f"expected {NAME_RULE}")
    return name


NewName = Annotated[
    str, StringConstraints(max_length=100), BeforeValidator(_name), Field(description=f"{NAME_RULE}.")
]
MOST_SITES = 100
SiteName = Annotated[str, StringConstraints(min_length=1, max_length=200, pattern=r"^[^\x00]+$")]
UserName = Annotated[str, StringConstraints(min_length=1, max_length=100, pattern=r"^[^\x00/]+$")]
Password = Annotated[str, StringConstraints(min_length=1, max_length=1024)]
Roles = Annotated[set[Role], Field(max_length=len(Role))]


Sites = Annotated[set[SiteName], Field(max_length=MOST_SITES)]


FactorCodeText = Annotated[str, StringConstraints(min_length=1, max_length=40)]


PasskeyText = Annotated[str, StringConstraints(min_length=2, max_length=LONGEST_ANSWER)]
AnyName = Annotated[str, StringConstraints(min_length=1, max_length=200)]


class LoginRequest(RequestDocument):
    """Who logs in. code: of their authenticator app, or a recovery code, where they have a second factor.

    passkey: in place of the code, what a browser's `PublicKeyCredential.toJSON()` gives, as text.
    """

    name: AnyName
    password: Password
    code: FactorCodeText | None = None
    passkey: PasskeyText | None = None


class LoginWays(Document):
    """How one logs in here. oidc: where a browser begins to log in at the plant's identity provider.

    notice: on the use of the service. Who logs in acknowledges it.
    """

    password: bool
    oidc: str | None
    notice: str | None


class Account(Document):
    """Who asks, and what they may do. way: how they showed who they are.

    password_set_by: who else gave them the password of this session; they change it before they do anything.
    sites: where the roles hold; null: at all of them.
    second_factor: "missing" where a role needs one and there is none; then one may but set it up.
    recovery_codes_left: that were not used.
    """

    name: str
    full_name: str | None
    roles: Listed[Role]
    sites: Listed[str] | None
    permissions: Listed[Permission]
    way: Literal["session", "token", "proxy", "none"]
    password_set_by: str | None
    second_factor: Literal["none", "missing", "set-up"]
    recovery_codes_left: int


class PasswordChange(RequestDocument):
    """The own password, old and new."""

    old: Password
    new: Password


class OwnPassword(RequestDocument):
    """The own password, again, for what a session left open must not do."""

    password: Password


class FactorCode(RequestDocument):
    """A code of the authenticator app that is being set up."""

    code: FactorCodeText


class TotpProposal(Document):
    """A secret for an authenticator app. uri: the same as the app reads it from a picture."""

    secret: str
    uri: str


class RecoveryCodes(Document):
    """Codes that stand for the second factor, each of them once. They are not kept here."""

    recovery_codes: Annotated[list[str], Field(max_length=CODES)]


class PasskeyOptions(Document):
    """What browsers ask a device with: PublicKeyCredentialCreationOptionsJSON, or ...RequestOptionsJSON.

    `PublicKeyCredential.parseCreationOptionsFromJSON` and `parseRequestOptionsFromJSON` read them.
    """

    options: dict[str, Any]


class PasskeyAnswer(RequestDocument):
    """What a device has made: `PublicKeyCredential.toJSON()`, as text. label: what its owner calls it."""

    label: Person
    answer: PasskeyText


class Passkey(Document):
    """A passkey of a user. used_time: when it last let them in."""

    id: str
    label: str
    created_time: Time = Field(validation_alias="created_ns")
    used_time: Time | None = Field(validation_alias="used_ns")


class Passkeys(Document):
    """All passkeys of a user."""

    items: Annotated[list[Passkey], Field(max_length=MOST_PASSKEYS)]


class NewPasskey(Passkey):
    """A passkey that was added. recovery_codes: for who had no second factor, shown this once."""

    recovery_codes: Annotated[list[str], Field(max_length=CODES)]


class OneTimeCode(Document):
    """A code that stands for the second factor once."""

    code: str


class NewPassword(RequestDocument):
    """Change password for a user."""

    password: Password


class User(Document):
    """Somebody who may log in. has_password: whether with a password; subject: with an identity provider.

    sites: where the roles hold; null: at all of them.
    has_second_factor: whether their password lets nobody in alone.
    locked_until_time: none of their logins is tried before from some address, because too many failed.
    password_set_by: who else gave them their password, until they change it.
    """

    name: str
    full_name: str | None
    roles: Listed[Role]
    sites: Listed[str] | None
    disabled: bool
    has_password: bool
    has_second_factor: bool
    subject: str | None
    created_time: Time = Field(validation_alias="created_ns")
    password_set_time: Time | None = Field(validation_alias="password_set_ns")
    password_set_by: str | None
    last_login_time: Time | None = Field(validation_alias="last_login_ns")
    last_login_origin: str | None
    locked_until_time: Time | None = None


class UserRequest(RequestDocument):
    """A new user, who changes the password first. Without one nobody can log in as them.

    The role SECAUD is given by the owner of the service's files alone. sites: where the roles hold, by
    default at all of them.
    """

    name: NewName
    full_name: Person | None = None
    roles: Roles
    sites: Sites | None = None
    password: Password | None = None


class UserChange(RequestDocument):
    """What is to be changed of a user; what is left out, or null, stays.

    sites: where the roles hold. all_sites: they hold everywhere.
    """

    full_name: Person | None = None
    roles: Roles | None = None
    sites: Sites | None = None
    all_sites: bool = False
    disabled: bool | None = None

    @model_validator(mode="after")
    def _has_one_reach(self) -> "UserChange":
        if self.all_sites and self.sites is not None:
            raise ValueError("expected `sites` or `all_sites`, found both")
        return self


class Token(Document):
    """A secret of a user for a program, without the secret. scope: null for all that the user may.

    sites: where it holds, of the user's; null for all of them.
    parent: the token that asked for this one, and with which it ends; null where a person did.
    """

    id: str
    user: str
    label: str
    scope: Listed[str] | None
    sites: Listed[str] | None
    parent: str | None
    created_time: Time = Field(validation_alias="created_ns")
    expires_time: Time | None = Field(validation_alias="expires_ns")
    used_time: Time | None = Field(validation_alias="used_ns")


class NewToken(Token):
    """A token with its secret, which is shown this once and not kept."""

    token: str


class TokenRequest(RequestDocument):
    """What a new token is for. scope: the permissions it has, by default all of who asks.

    sites: where it holds, by default at all of who asks.
    expires_time: by default as late as the settings, and the token that asks, let it.
    """

    label: Person
    scope: Annotated[set[Permission], Field(min_length=1, max_length=len(Permission))] | None = None
    sites: Annotated[set[SiteName], Field(min_length=1, max_length=MOST_SITES)] | None = None
    expires_time: TimeParameter | None = None
