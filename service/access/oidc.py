"""Sign-on at the plant's OpenID provider: authorization code with PKCE, state and nonce.

What the provider is asked for has time limits and bounds on its answers. Its keys are read again when one
signs that is not known yet, at most every ten seconds.
"""

import json
import secrets
import ssl
import time
from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPStatus
from threading import Lock
from typing import Any, Final
from urllib.parse import urlsplit

import httpx
from authlib.common.errors import AuthlibBaseError
from authlib.oauth2.rfc6749.parameters import prepare_grant_uri
from authlib.oauth2.rfc7636 import create_s256_code_challenge
from authlib.oidc.core import CodeIDToken
from joserfc import jwt
from joserfc.errors import InvalidKeyIdError, JoseError
from joserfc.jwk import JWKRegistry, KeySet

from mms import CredentialFileError, read_secret
from service.access.bearer_secrets import LONGEST
from service.access.proxied import roles_of, sites_of
from service.access.reach import Sites
from service.access.user_names import name_of
from service.configuration.access import OidcSettings
from service.storage.records import Role

LARGEST_BYTES: Final = 1 << 20
KEYS_AGAIN_S: Final = 10.0
LEEWAY_S: Final = 60
ALGORITHMS: Final = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "EdDSA")
"""Signatures with a key that the provider alone has."""

Document = Mapping[str, Any]


class ProviderError(Exception):
    """The provider does not answer, or not as OpenID Connect has it; sign-on may work later."""


class SignOnRefusedError(Exception):
    """What came back from the provider lets nobody in; it says why."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """What a browser keeps between its way to the provider and back."""

    state: str
    nonce: str
    verifier: str

    @classmethod
    def new(cls) -> "Attempt":
        return cls(*(secrets.token_urlsafe(32) for _ in range(3)))

    @classmethod
    def of(cls, text: str) -> "Attempt | None":
        """Return what `text` holds; None where it is none of ours."""
        parts = text.split(".")
        fits = len(parts) == 3 and all(0 < len(part) <= LONGEST for part in parts)
        return cls(*parts) if fits else None

    def text(self) -> str:
        return f"{self.state}.{self.nonce}.{self.verifier}"


@dataclass(frozen=True, slots=True)
class SignedOn:
    """Whom a provider names. subject: the provider and what it calls them for good.

    session: the provider and what it calls this login; None where it does not tell.
    sites: where its groups let them be; None where they do not tell.
    """

    subject: str
    session: str | None
    name: str
    full_name: str | None
    roles: frozenset[Role]
    sites: Sites


class OpenIdProvider:
    """One provider; may be asked from several threads."""

    def __init__(self, settings: OidcSettings) -> None:
        self._settings = settings
        self._lock = Lock()
        self._about: Document | None = None
        self._keys: KeySet | None = None
        self._keys_read_s = float("-inf")

    def address(self, attempt: Attempt) -> str:
        """Return where a browser goes to log in. Raises ProviderError."""
        return str(
            prepare_grant_uri(
                self._endpoint("authorization_endpoint"),
                client_id=self._settings.client_id,
                response_type="code",
                redirect_uri=str(self._settings.redirect_url),
                scope=" ".join(self._settings.scopes),
                state=attempt.state,
                nonce=attempt.nonce,
                code_challenge=create_s256_code_challenge(attempt.verifier),
                code_challenge_method="S256",
            )
        )

    def sign_on(self, code: str, attempt: Attempt) -> SignedOn:
        """Return who came back with a code. Raises ProviderError, SignOnRefusedError."""
        answer = self._exchange(code, attempt)
        id_token = answer.get("id_token")
        if not isinstance(id_token, str):
            raise SignOnRefusedError("the provider gave no ID token")
        claims = self._claims(id_token, attempt, answer.get("access_token"))
        return self._signed_on(claims)

    @property
    def client_id(self) -> str:
        """Return how the provider calls this service."""
        return self._settings.client_id

    def signed_claims(self, token: str) -> Document:
        """Return what a token says that the provider has signed. Raises ProviderError, SignOnRefusedError."""
        try:
            return dict(self._decoded(token).claims)
        except (JoseError, ValueError, TypeError, KeyError) as error:
            raise SignOnRefusedError(f"the token does not hold: {type(error).__name__}") from error

    def _exchange(self, code: str, attempt: Attempt) -> Document:
        settings = self._settings
        form = {
            "grant_type": "authorization_code",
            "code": code,
            "redirect_uri": str(settings.redirect_url),
            "code_verifier": attempt.verifier,
        }
        authentication = None
        if settings.client_secret_file is None:
            form["client_id"] = settings.client_id
        else:
            try:
                secret = read_secret(settings.client_secret_file).decode().strip()
            except (CredentialFileError, UnicodeDecodeError) as error:
                raise ProviderError(f"client_secret_file cannot be used: {error}") from error
            authentication = httpx.BasicAuth(settings.client_id, secret)
        status, answer = self._ask("POST", self._endpoint("token_endpoint"), form, authentication)
        if status == HTTPStatus.OK:
            return answer
        if status < HTTPStatus.INTERNAL_SERVER_ERROR:
            raise SignOnRefusedError(f"the provider did not take the code: {str(answer.get('error'))[:100]}")
        raise ProviderError(f"the provider answered {status}")

    def _claims(self, id_token: str, attempt: Attempt, access_token: object) -> Document:
        try:
            token = self._decoded(id_token)
            claims = CodeIDToken(
                token.claims,
                token.header,
                options={"iss": {"essential": True, "value": self.issuer()}},
                params={
                    "nonce": attempt.nonce,
                    "client_id": self._settings.client_id,
                    "access_token": access_token if isinstance(access_token, str) else None,
                },
            )
            claims.validate(leeway=LEEWAY_S)
        except (JoseError, AuthlibBaseError, ValueError, TypeError, KeyError) as error:
            raise SignOnRefusedError(f"the ID token does not hold: {type(error).__name__}") from error
        audience = token.claims.get("aud")
        if self._settings.client_id not in (audience if isinstance(audience, list) else [audience]):
            raise SignOnRefusedError("the ID token is for another client")
        if token.claims.get("nonce") != attempt.nonce:
            raise SignOnRefusedError("the ID token is of another attempt")
        return dict(token.claims)

    def _decoded(self, id_token: str) -> jwt.Token:
        try:
            return jwt.decode(id_token, self._key_set(), algorithms=ALGORITHMS)
        except InvalidKeyIdError:  # the provider has changed its keys
            return jwt.decode(id_token, self._key_set(again=True), algorithms=ALGORITHMS)

    def _signed_on(self, claims: Document) -> SignedOn:
        settings = self._settings
        said, subject = _claim(claims, settings.name_claim), claims.get("sub")
        name = name_of(said) if isinstance(said, str) else None
        if name is None:
            raise SignOnRefusedError(f"the claim {settings.name_claim} is no user's name here")
        if not isinstance(subject, str) or not 0 < len(subject) <= 255:
            raise SignOnRefusedError("the ID token names nobody (sub)")
        found = _claim(claims, settings.roles_claim)
        told = [found] if isinstance(found, str) else found if isinstance(found, list) else []
        groups = [group for group in told if isinstance(group, str)]
        full_name, session = claims.get("name"), claims.get("sid")
        return SignedOn(
            f"{self.issuer()} {subject}",
            f"{self.issuer()} {session}" if isinstance(session, str) and 0 < len(session) <= 255 else None,
            name,
            full_name[:100] if isinstance(full_name, str) and full_name.isprintable() else None,
            roles_of(groups, settings.roles),
            sites_of(groups, settings.sites),
        )

    def issuer(self) -> str:
        """Return how the provider calls itself. Raises ProviderError."""
        return str(self._discovered()["issuer"])

    def _endpoint(self, name: str) -> str:
        address = self._discovered().get(name)
        if not isinstance(address, str) or not is_safe(address):
            raise ProviderError(f"the provider's {name} is no https address")
        return address

    def _discovered(self) -> Document:
        """Return what the provider says of itself; read once. Raises ProviderError."""
        with self._lock:
            if self._about is None:
                issuer = str(self._settings.issuer).rstrip("/")
                address = f"{issuer}/.well-known/openid-configuration"
                status, about = self._ask("GET", address)
                if status != HTTPStatus.OK or str(about.get("issuer")).rstrip("/") != issuer:
                    raise ProviderError(f"{address}: expected what {issuer} says of itself, found {status}")
                self._about = about
            return self._about

    def _key_set(self, *, again: bool = False) -> KeySet:
        address = self._endpoint("jwks_uri")
        with self._lock:
            is_old = time.monotonic() >= self._keys_read_s + KEYS_AGAIN_S
            if self._keys is None or (again and is_old):
                status, found = self._ask("GET", address)
                if status != HTTPStatus.OK:
                    raise ProviderError(f"the provider's keys cannot be read: {status}")
                self._keys = _usable_keys(found)
                self._keys_read_s = time.monotonic()
            return self._keys

    def _ask(
        self,
        method: str,
        address: str,
        form: Mapping[str, str] | None = None,
        authentication: httpx.BasicAuth | None = None,
    ) -> tuple[int, Document]:
        """Return the status and the JSON object of an answer. Raises ProviderError."""
        settings = self._settings
        deadline_s = time.monotonic() + settings.timeout_s
        try:
            trusted: ssl.SSLContext = ssl.create_default_context()
            if settings.ca is not None:
                trusted.load_verify_locations(settings.ca)
            with (
                httpx.Client(verify=trusted, timeout=settings.timeout_s, trust_env=False) as client,
                client.stream(
                    method, address, data=form, auth=authentication, headers={"Accept": "application/json"}
                ) as answer,
            ):
                content = bytearray()
                for piece in answer.iter_bytes():
                    content += piece
                    if len(content) > LARGEST_BYTES or time.monotonic() > deadline_s:
                        raise ProviderError("the provider's answer is too long, or too slow")
                return answer.status_code, _json_object(bytes(content))
        except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
            raise ProviderError(f"the provider does not answer ({type(error).__name__}: {error})") from error


def is_safe(address: str) -> bool:
    """Tell whether what goes to an address is encrypted, or stays on this machine."""
    try:
        parts = urlsplit(address)
    except ValueError:
        return False
    is_local = parts.hostname in ("localhost", "127.0.0.1", "::1")
    return bool(parts.hostname) and (parts.scheme == "https" or (parts.scheme == "http" and is_local))


def _json_object(content: bytes) -> Document:
    """Return a JSON object; an empty one for anything else."""
    try:
        found = json.loads(content)
    except (ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _usable_keys(found: Document) -> KeySet:
    """Return the public keys of a set that sign; one that nobody knows is no reason to know none."""
    keys = found.get("keys")
    usable = []
    for key in keys if isinstance(keys, list) else []:
        is_public = isinstance(key, dict) and key.get("kty") in ("RSA", "EC", "OKP")
        if is_public and key.get("use", "sig") == "sig":
            try:
                usable.append(JWKRegistry.import_key(key))
            except (JoseError, ValueError, TypeError, KeyError):
                continue
    if not usable:
        raise ProviderError("the provider has no key that signs")
    return KeySet(usable)


def _claim(claims: Document, way: str) -> object:
    """Return a claim; `a.b` is b within a, unless a claim has that name."""
    if way in claims:
        return claims[way]
    found: object = claims
    for name in way.split("."):
        found = found.get(name) if isinstance(found, Mapping) else None
    return found
