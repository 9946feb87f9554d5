"""A document posted to an address over HTTP, signed as the Standard Webhooks specification says.

    webhook-id: the message's id, the same at every attempt
    webhook-timestamp: seconds since 1970 of this attempt
    webhook-signature: v1,BASE64(HMAC-SHA256(key, "ID.TIMESTAMP.BODY"))

Libraries of many languages check such a signature (https://www.standardwebhooks.com);
examples/webhook_receiver.py does it without one. The service goes to the address that is configured and to no
other: it follows no redirection, and no variable of the environment names it a proxy.
"""

import base64
import hashlib
import hmac
import json
import time
from collections.abc import Mapping

import httpx

from service.configuration.channel_secrets import signing_key, url
from service.configuration.channels import WebhookChannel
from service.senders.chat_documents import slack_document, teams_document
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.tls import client_context

GONE = 410
"""The receiver says that it wants no more."""


async def post_webhook(name: str, channel: WebhookChannel, message: Message) -> None:
    """Post a message. Raises SendError, ChannelSecretError."""
    address, key = url(name, channel), signing_key(name, channel)
    body = json.dumps(_document(channel, message), ensure_ascii=False, allow_nan=False).encode()
    headers = {"Content-Type": "application/json", "User-Agent": "StatorWatch"}
    headers |= signature_headers(message.id, int(time.time()), body, key)
    verify = client_context(channel.ca) if address.startswith("https:") else False
    try:
        async with (
            httpx.AsyncClient(
                verify=verify, trust_env=False, follow_redirects=False, timeout=channel.timeout_s
            ) as client,
            client.stream("POST", address, content=body, headers=headers) as response,
        ):
            status = response.status_code
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        # Only what kind of error it was where the text may show the address: a path can be a secret.
        words = str(error) if isinstance(error, httpx.NetworkError) else ""
        raise SendError(f"{_host(address)}: {words or type(error).__name__}") from error
    if not 200 <= status < 300:
        raise SendError(f"{_host(address)} answers HTTP status {status}", is_final=status == GONE)


def signature_headers(message_id: str, timestamp: int, body: bytes, key: bytes | None) -> Mapping[str, str]:
    """Return the headers that tell a receiver who sends, what and when; without a key none is signed."""
    headers = {"webhook-id": message_id, "webhook-timestamp": str(timestamp)}
    if key is None:
        return headers
    signed = hmac.digest(key, f"{message_id}.{timestamp}.".encode() + body, hashlib.sha256)
    return headers | {"webhook-signature": f"v1,{base64.b64encode(signed).decode()}"}


def _document(channel: WebhookChannel, message: Message) -> Mapping[str, object]:
    match channel.format:
        case "slack":
            return slack_document(message)
        case "teams":
            return teams_document(message)
        case "standard":
            return message.document


def _host(address: str) -> str:
    """Return where a message went, without the path."""
    parsed = httpx.URL(address)
    return f"{parsed.scheme}://{parsed.netloc.decode('ascii', 'replace')}"
