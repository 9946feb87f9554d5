"""Passkeys (WebAuthn): a key that a device keeps, and uses at the service's own address alone.

A challenge is sealed for one login of one account, or one session of a user. So nothing is kept of those that
nobody answers, and none can be forged. It lasts five minutes, and is answered once.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from ipaddress import ip_address
from typing import Any, Final, Self
from urllib.parse import urlsplit

from webauthn import (
    generate_authentication_options,
    generate_registration_options,
    options_to_json,
    verify_authentication_response,
    verify_registration_response,
)
from webauthn.helpers import (
    base64url_to_bytes,
    bytes_to_base64url,
    parse_authentication_credential_json,
    parse_client_data_json,
    parse_registration_credential_json,
)
from webauthn.helpers.exceptions import WebAuthnException
from webauthn.helpers.structs import (
    AuthenticatorSelectionCriteria,
    PublicKeyCredentialDescriptor,
    ResidentKeyRequirement,
    UserVerificationRequirement,
)

from core.units import NANOSECONDS_PER_SECOND
from service.access.bearer_secrets import digest_of
from service.access.second_factors import ISSUER, FactorError, digest_of_code, new_recovery_codes
from service.audit.actions import AuditAction
from service.process.sealing import Seal, SealError
from service.storage import Repository
from service.storage.records import Actor, NewPasskey, Passkey

CHALLENGE_S: Final = 300
LONGEST_ANSWER: Final = 6000
"""Characters of what a browser sends of a passkey. Without attestation it has some hundreds to 2500."""

MOST_PASSKEYS: Final = 20
"""A user has at most so many."""

LOCAL: Final = ("localhost", "localhost.localdomain")
UNREADABLE: Final = (WebAuthnException, ValueError, TypeError, KeyError, IndexError, RecursionError)
"""What the library raises for answers that are none, or do not hold."""


class NoPasskeysError(FactorError):
    """Browsers cannot use passkeys here; it says which setting lets them."""


class PasskeyRefusedError(FactorError):
    """What a browser sent of a passkey does not hold; it says why."""


@dataclass(frozen=True, slots=True)
class PasskeyPlace:
    """The address at which passkeys of the service count. host: the id of the relying party."""

    host: str
    origin: str

    @classmethod
    def of(cls, address: str | None) -> Self:
        """Return the place of a service that people reach at this address. Raises NoPasskeysError."""
        expected = "passkeys need a name and TLS: expected setting notifications.address such as https://mcc.plant.example"
        if address is None:
            raise NoPasskeysError(f"{expected}, found none")
        parts = urlsplit(address)
        host = parts.hostname or ""
        if _is_ip_address(host) or not (parts.scheme == "https" or host in LOCAL):
            raise NoPasskeysError(f"{expected}, found {address}")
        return cls(host, f"{parts.scheme}://{parts.netloc.lower()}")


def registration_options(
    repository: Repository, seal: Seal, place: PasskeyPlace, session: str, *, by: Actor, now_ns: int
) -> dict[str, Any]:
    """Return what a browser asks a device for a new passkey with. session: the digest of who asks.

    Raises NotFoundError.
    """
    user = repository.user(by.name)
    begun = {"kind": "passkey"}
    repository.note_by(by, AuditAction.SECOND_FACTOR_BEGUN, ("user", user.name), now_ns=now_ns, after=begun)
    options = generate_registration_options(
        rp_id=place.host,
        rp_name=ISSUER,
        user_id=sha256(f"{place.host} {user.name}".encode()).digest(),
        user_name=user.name,
        user_display_name=user.full_name or user.name,
        challenge=_challenge(seal, _registration(user.name, session), now_ns=now_ns),
        timeout=CHALLENGE_S * 1000,
        authenticator_selection=AuthenticatorSelectionCriteria(
            resident_key=ResidentKeyRequirement.REQUIRED,  # a login asks for no certain device
            user_verification=UserVerificationRequirement.PREFERRED,
        ),
        exclude_credentials=[
            PublicKeyCredentialDescriptor(id=base64url_to_bytes(one.credential))
            for one in repository.passkeys(user.name)
        ],
    )
    return _document(options_to_json(options))


def add_passkey(
    repository: Repository,
    seal: Seal,
    place: PasskeyPlace,
    user: str,
    label: str,
    answer: str,
    *,
    session: str,
    by: Actor,
    now_ns: int,
) -> tuple[Passkey, Sequence[str]]:
    """Keep a new passkey; return it, and new recovery codes for who had no second factor before.

    Raises PasskeyRefusedError, NotFoundError, PasskeyExistsError.
    """
    try:
        credential = parse_registration_credential_json(_document(answer))
        challenge = parse_client_data_json(credential.response.client_data_json).challenge
        _spend(repository, seal, challenge, _registration(user, session), now_ns=now_ns)
        made = verify_registration_response(
            credential=credential,
            expected_challenge=challenge,
            expected_rp_id=place.host,
            expected_origin=place.origin,
        )
    except UNREADABLE as error:
        raise PasskeyRefusedError(_reason(error)) from error
    new = NewPasskey(
        bytes_to_base64url(made.credential_id),
        bytes_to_base64url(made.credential_public_key),
        made.sign_count,
    )
    codes = new_recovery_codes()
    kept, codes_count = repository.add_passkey(
        user,
        label,
        new,
        most=MOST_PASSKEYS,
        codes=map(digest_of_code, codes),
        keeps=session,
        by=by,
        now_ns=now_ns,
    )
    return kept, codes if codes_count else ()


def login_options(seal: Seal, place: PasskeyPlace, account: str, *, now_ns: int) -> dict[str, Any]:
    """Return what a browser asks a device with to log in to an account, whether there is one or not."""
    options = generate_authentication_options(
        rp_id=place.host,
        challenge=_challenge(seal, _login(account), now_ns=now_ns),
        timeout=CHALLENGE_S * 1000,
        user_verification=UserVerificationRequirement.PREFERRED,
    )
    return _document(options_to_json(options))


def require_passkey(
    repository: Repository, seal: Seal, place: PasskeyPlace, account: str, answer: str, *, now_ns: int
) -> None:
    """Take the answer of a passkey of this account, once. Raises PasskeyRefusedError."""
    try:
        credential = parse_authentication_credential_json(_document(answer))
        challenge = parse_client_data_json(credential.response.client_data_json).challenge
        _spend(repository, seal, challenge, _login(account), now_ns=now_ns)
        passkey = repository.passkey_of(account, bytes_to_base64url(credential.raw_id))
        if passkey is None:
            raise PasskeyRefusedError("no passkey of this user")
        shown = verify_authentication_response(
            credential=credential,
            expected_challenge=challenge,
            expected_rp_id=place.host,
            expected_origin=place.origin,
            credential_public_key=base64url_to_bytes(passkey.public_key),
            credential_current_sign_count=0,  # compared below, while nobody else changes it
        )
    except UNREADABLE as error:
        raise PasskeyRefusedError(_reason(error)) from error
    if not repository.use_passkey(passkey.id, shown.new_sign_count, now_ns=now_ns):
        raise PasskeyRefusedError(
            f"passkey {passkey.label!r}: expected more than {passkey.signatures} signatures, found "
            f"{shown.new_sign_count}: somebody may have a copy of it"
        )


def _challenge(seal: Seal, purpose: str, *, now_ns: int) -> bytes:
    """Return a challenge that nobody else can make, for one purpose."""
    return seal.closed(str(now_ns + CHALLENGE_S * NANOSECONDS_PER_SECOND), purpose).encode()


def _spend(repository: Repository, seal: Seal, challenge: bytes, purpose: str, *, now_ns: int) -> None:
    """Use up a challenge. Raises PasskeyRefusedError where it is none of ours for this, too old or used."""
    try:
        expires_ns = int(seal.opened(challenge.decode(), purpose))
    except SealError as error:
        raise PasskeyRefusedError("the challenge was not made for this") from error
    if expires_ns <= now_ns:
        raise PasskeyRefusedError("the challenge is too old")
    if not repository.use_once(digest_of(challenge.decode()), expires_ns=expires_ns, now_ns=now_ns):
        raise PasskeyRefusedError("the challenge was answered before")


def _login(account: str) -> str:
    return f"passkey login of {account}"


def _registration(user: str, session: str) -> str:
    return f"new passkey of {user} in session {session}"


def _document(text: str) -> dict[str, Any]:
    """Return a JSON object. Raises ValueError, TypeError, RecursionError."""
    found = json.loads(text)
    if not isinstance(found, dict):
        raise TypeError("expected a JSON object")
    return found


def _reason(error: Exception) -> str:
    """Return why an answer does not hold, in one short line."""
    return f"the answer of the passkey does not hold: {str(error)[:200]!r}"


def _is_ip_address(host: str) -> bool:
    try:
        ip_address(host)
    except ValueError:
        return False
    return True
