"""A device with passkeys, in software: it answers what browsers ask devices (WebAuthn level 2)."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Any

import cbor2
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from webauthn.helpers import base64url_to_bytes, bytes_to_base64url

PRESENT, VERIFIED, HAS_KEY = 0x01, 0x04, 0x40
"""Flags of what the device knows: somebody is there, who they are, and that a new key follows."""


@dataclass
class Authenticator:
    """A device with a passkey for each request for one. origin: of the page; rp_id: whom it takes it for."""

    origin: str
    rp_id: str
    flags: int = PRESENT | VERIFIED
    counts: bool = True
    signatures: int = 0
    keys: dict[bytes, ec.EllipticCurvePrivateKey] = field(default_factory=dict)

    def create(self, options: Mapping[str, Any]) -> str:
        """Answer a request for a new passkey."""
        credential, key = os.urandom(32), ec.generate_private_key(ec.SECP256R1())
        self.keys[credential] = key
        numbers = key.public_key().public_numbers()
        public = {1: 2, 3: -7, -1: 1, -2: numbers.x.to_bytes(32), -3: numbers.y.to_bytes(32)}
        added = bytes(16) + len(credential).to_bytes(2) + credential + cbor2.dumps(public)
        about = {"fmt": "none", "attStmt": {}, "authData": self._data(HAS_KEY) + added}
        return self._answer(
            credential,
            {
                "clientDataJSON": self._client_data("webauthn.create", options),
                "attestationObject": bytes_to_base64url(cbor2.dumps(about)),
            },
        )

    def get(self, options: Mapping[str, Any], credential: bytes | None = None) -> str:
        """Answer a login. credential: with which passkey, by default the first one."""
        name = next(iter(self.keys)) if credential is None else credential
        if self.counts:
            self.signatures += 1
        client_data, data = self._client_data("webauthn.get", options), self._data()
        signed = data + sha256(base64url_to_bytes(client_data)).digest()
        return self._answer(
            name,
            {
                "clientDataJSON": client_data,
                "authenticatorData": bytes_to_base64url(data),
                "signature": bytes_to_base64url(self.keys[name].sign(signed, ec.ECDSA(SHA256()))),
            },
        )

    def _data(self, flags: int = 0) -> bytes:
        rp = sha256(self.rp_id.encode()).digest()
        return rp + (self.flags | flags).to_bytes() + self.signatures.to_bytes(4)

    def _client_data(self, kind: str, options: Mapping[str, Any]) -> str:
        about = {"type": kind, "challenge": options["challenge"], "origin": self.origin, "crossOrigin": False}
        return bytes_to_base64url(json.dumps(about).encode())

    def _answer(self, credential: bytes, response: Mapping[str, str]) -> str:
        name = bytes_to_base64url(credential)
        return json.dumps({"id": name, "rawId": name, "type": "public-key", "response": response})
