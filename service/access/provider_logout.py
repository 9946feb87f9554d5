"""What the plant's identity provider says when it ends somebody's logins.

That is OpenID Connect Back-Channel Logout 1.0. A logout token is signed as an ID token is. It counts for ten
minutes, and once.
"""

from dataclasses import dataclass
from typing import Final

from service.access.bearer_secrets import digest_of
from service.access.oidc import LEEWAY_S, Document, OpenIdProvider, SignOnRefusedError

EVENT: Final = "http://schemas.openid.net/event/backchannel-logout"
OLDEST_S: Final = 600
LONGEST_ID: Final = 255


@dataclass(frozen=True, slots=True)
class ProviderLogout:
    """Whose logins end. subject, session: as users and sessions here know them; None: it names none.

    digest: of what the token has only once. expires_s: no token of this kind is taken later [s since 1970].
    """

    issuer: str
    subject: str | None
    session: str | None
    digest: str
    expires_s: int


def provider_logout(provider: OpenIdProvider, token: str, *, now_s: float) -> ProviderLogout:
    """Return what a logout token says. Raises ProviderError, SignOnRefusedError."""
    claims, issuer = provider.signed_claims(token), provider.issuer()
    if claims.get("iss") != issuer:
        raise SignOnRefusedError("the logout token is of another provider")
    audience = claims.get("aud")
    if provider.client_id not in (audience if isinstance(audience, list) else [audience]):
        raise SignOnRefusedError("the logout token is for another client")
    events = claims.get("events")
    if not isinstance(events, dict) or not isinstance(events.get(EVENT), dict) or "nonce" in claims:
        raise SignOnRefusedError("expected a logout token, found another one")
    issued_s = _seconds(claims, "iat")
    expires_s = (
        issued_s + OLDEST_S if "exp" not in claims else min(_seconds(claims, "exp"), issued_s + OLDEST_S)
    )
    if issued_s > now_s + LEEWAY_S or expires_s <= now_s - LEEWAY_S:
        raise SignOnRefusedError("the logout token is too old, or not valid yet")
    token_id, subject, session = (_text(claims, name) for name in ("jti", "sub", "sid"))
    if token_id is None or (subject is None and session is None):
        raise SignOnRefusedError("the logout token names nobody (sub, sid), or not itself (jti)")
    return ProviderLogout(
        issuer,
        None if subject is None else f"{issuer} {subject}",
        None if session is None else f"{issuer} {session}",
        digest_of(f"logout token {issuer} {token_id}"),
        expires_s + LEEWAY_S,
    )


def _seconds(claims: Document, name: str) -> int:
    found = claims.get(name)
    if isinstance(found, bool) or not isinstance(found, int | float) or not 0 <= found < 1e11:
        raise SignOnRefusedError(f"the logout token has no time {name}")
    return int(found)


def _text(claims: Document, name: str) -> str | None:
    """Return a name of a claim; None where it is left out. Raises SignOnRefusedError for one that is none."""
    found = claims.get(name)
    if found is None:
        return None
    if not isinstance(found, str) or not 0 < len(found) <= LONGEST_ID:
        raise SignOnRefusedError(f"the logout token has no text {name}")
    return found
