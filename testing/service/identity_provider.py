"""An OpenID provider that logs in whoever comes, with keys of its own; it speaks HTTP on the loopback."""

import base64
import hashlib
import json
import secrets
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlencode, urlsplit

from joserfc import jwt
from joserfc.jwk import ECKey, KeyParameters, KeySet, RSAKey

CLIENT = "statorwatch"
LOGOUT = "http://schemas.openid.net/event/backchannel-logout"
SECRET = "s3cret"  # noqa: S105 - of nobody


@dataclass
class IdentityProvider:
    """claims: of whoever logs in. spoil: changes the claims of tokens. asked: paths, in their order."""

    url: str = ""
    claims: dict[str, Any] = field(default_factory=dict)
    spoil: dict[str, Any] = field(default_factory=dict)
    header: dict[str, Any] = field(default_factory=dict)
    keys: list[RSAKey | ECKey] = field(default_factory=list)
    signing: RSAKey | ECKey | None = None
    asked: list[str] = field(default_factory=list)
    delay_s: float = 0.0
    wants_secret: bool = True
    codes: dict[str, dict[str, str]] = field(default_factory=dict)

    def rotate(self, kind: type[RSAKey] | type[ECKey] = RSAKey) -> None:
        """Sign with a new key; the old ones are published no more."""
        parameters: KeyParameters = {"kid": secrets.token_hex(4), "use": "sig"}
        key = (
            RSAKey.generate_key(2048, parameters)
            if kind is RSAKey
            else ECKey.generate_key("P-256", parameters)
        )
        self.keys = [key]
        self.signing = key

    def token(self, asked: dict[str, str]) -> str:
        """An ID token for a request to log in."""
        now = int(time.time())
        times = {"exp": now + 300, "iat": now}
        claims = {"iss": self.url, "aud": CLIENT, **times, "nonce": asked["nonce"], **self.claims}
        return self.signed(claims | self.spoil)

    def logout_token(self, **claims: object) -> str:
        """What the provider sends when it has ended logins; None leaves a claim out."""
        now = int(time.time())
        ended = {"iss": self.url, "aud": CLIENT, "iat": now, "exp": now + 120, "events": {LOGOUT: {}}}
        return self.signed({**ended, "jti": secrets.token_hex(8), **claims})

    def signed(self, claims: dict[str, Any]) -> str:
        """A token with these claims, of those that are not None."""
        assert self.signing is not None
        algorithm = "RS256" if isinstance(self.signing, RSAKey) else "ES256"
        header = {"alg": algorithm, "kid": self.signing.kid, **self.header}
        claims = {name: value for name, value in claims.items() if value is not None}
        return jwt.encode(header, claims, self.signing)


class _Handler(BaseHTTPRequestHandler):
    provider: IdentityProvider

    def do_GET(self) -> None:
        provider, parts = self.provider, urlsplit(self.path)
        provider.asked.append(parts.path)
        time.sleep(provider.delay_s)
        match parts.path:
            case "/.well-known/openid-configuration":
                about = {"issuer": provider.url, "jwks_uri": f"{provider.url}/keys"}
                about |= {f"{name}_endpoint": f"{provider.url}/{name}" for name in ("authorization", "token")}
                self._answer(200, about)
            case "/keys":
                self._answer(200, dict(KeySet(list(provider.keys)).as_dict()))
            case "/authorization":
                asked = {name: values[0] for name, values in parse_qs(parts.query).items()}
                code = secrets.token_urlsafe(16)
                provider.codes[code] = asked
                self.send_response(302)
                back = urlencode({"code": code, "state": asked["state"], "iss": provider.url})
                self.send_header("Location", f"{asked['redirect_uri']}?{back}")
                self.end_headers()
            case _:
                self._answer(404, {})

    def do_POST(self) -> None:
        provider = self.provider
        provider.asked.append(self.path)
        time.sleep(provider.delay_s)
        body = self.rfile.read(int(self.headers["Content-Length"])).decode()
        form = {name: values[0] for name, values in parse_qs(body).items()}
        asked = provider.codes.pop(form.get("code", ""), None)
        basic = "Basic " + base64.b64encode(f"{CLIENT}:{SECRET}".encode()).decode()
        if provider.wants_secret and self.headers.get("Authorization") != basic:
            self._answer(401, {"error": "invalid_client"})
            return
        challenge = hashlib.sha256(form.get("code_verifier", "").encode()).digest()
        proven = base64.urlsafe_b64encode(challenge).decode().rstrip("=")
        if (
            asked is None
            or asked["code_challenge"] != proven
            or asked["redirect_uri"] != form["redirect_uri"]
        ):
            self._answer(400, {"error": "invalid_grant"})
            return
        self._answer(200, {"id_token": provider.token(asked), "token_type": "Bearer", "access_token": "x"})

    def log_message(self, format: str, *_: object) -> None:  # noqa: A002 - the name of http.server
        pass

    def _answer(self, status: int, document: dict[str, Any]) -> None:
        content = json.dumps(document).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)


@contextmanager
def identity_provider() -> Iterator[IdentityProvider]:
    """A provider that answers while the block runs."""
    provider = IdentityProvider()
    provider.rotate()
    handler = type("Handler", (_Handler,), {"provider": provider})
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        provider.url = f"http://127.0.0.1:{server.server_port}"
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            yield provider
        finally:
            server.shutdown()
            thread.join()
