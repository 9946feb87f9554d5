"""Webhooks as a real HTTP server gets them."""

import base64
import json
from pathlib import Path
from typing import Any

import pytest
from standardwebhooks.webhooks import Webhook, WebhookVerificationError

from service.configuration.channels import WebhookChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.sending import send
from testing.service.receivers import http_receiver
from tests.service.senders.conftest import HOSTILE

KEY = base64.b64encode(bytes(range(32))).decode()


def channel(url: str | None, **more: object) -> WebhookChannel:
    return WebhookChannel.model_validate({"kind": "webhook", "url": url, "timeout_s": 20, **more})


def test_the_signature_is_that_of_the_standard(message: Message, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MCC_NOTIFY_SECRET_CMMS", f"whsec_{KEY}")
    with http_receiver() as receiver:
        send("cmms", channel(receiver.url), "", message)
    (posted,) = receiver.requests
    # The standard's own library checks it, with the time.
    assert Webhook(f"whsec_{KEY}").verify(posted.body, posted.headers) == message.document
    assert posted.headers["webhook-id"] == message.id, "the same at every attempt"
    with pytest.raises(WebhookVerificationError):
        Webhook(f"whsec_{KEY}").verify(posted.body.replace(b"P-101", b"P-102"), posted.headers)


def test_a_key_in_words_signs_too_and_a_short_one_is_refused(tmp_path: Path, message: Message) -> None:
    secret = tmp_path / "key"
    secret.touch(mode=0o600)
    secret.write_text("a sentence that nobody else knows\n")
    with http_receiver() as receiver:
        send("cmms", channel(receiver.url, secret_file=secret), "", message)
        (posted,) = receiver.requests
        key = base64.b64encode(b"a sentence that nobody else knows").decode()
        Webhook(key).verify(posted.body, posted.headers)
        secret.write_text("too short")
        with pytest.raises(SendError, match="at least 24 bytes, found 9"):
            send("cmms", channel(receiver.url, secret_file=secret), "", message)
    assert len(receiver.requests) == 1


def test_no_redirection_is_followed_and_no_proxy_used(
    message: Message, monkeypatch: pytest.MonkeyPatch
) -> None:
    with http_receiver() as inside, http_receiver() as receiver:
        monkeypatch.setenv("HTTP_PROXY", f"http://127.0.0.1:{inside.port}")
        receiver.statuses, receiver.location = [307], inside.url
        with pytest.raises(SendError, match="answers HTTP status 307"):
            send("cmms", channel(receiver.url), "", message)
    assert len(receiver.requests) == 1
    assert inside.requests == []


@pytest.mark.parametrize(("status", "is_final"), [(500, False), (404, False), (429, False), (410, True)])
def test_a_refusal_says_whether_to_try_again(message: Message, status: int, is_final: bool) -> None:
    with http_receiver() as receiver:
        receiver.statuses = [status]
        with pytest.raises(SendError, match=f"answers HTTP status {status}") as refused:
            send("cmms", channel(receiver.url), "", message)
    assert refused.value.is_final is is_final


def test_an_address_that_is_a_secret_is_in_no_error(tmp_path: Path, message: Message) -> None:
    secret = tmp_path / "url"
    secret.touch(mode=0o600)
    with http_receiver() as receiver:
        secret.write_text(f"{receiver.url}/T0K3N?key=S3CR3T\n")
        receiver.statuses = [403]
        with pytest.raises(SendError) as refused:
            send("chat", channel(None, url_file=secret), "", message)
        receiver.answers.clear()
        with pytest.raises(SendError) as silent:
            send("chat", channel(None, url_file=secret, timeout_s=0.3), "", message)
    with pytest.raises(SendError) as gone:
        send("chat", channel(None, url_file=secret), "", message)
    assert receiver.requests[0].path == "/hook/T0K3N?key=S3CR3T"
    for error in (refused, silent, gone):
        assert "T0K3N" not in str(error.value)
        assert "S3CR3T" not in str(error.value)


def test_chat_services_get_names_as_they_are_and_no_markup(message: Message) -> None:
    with http_receiver() as receiver:
        send("slack", channel(receiver.url, format="slack"), "", message)
        send("teams", channel(receiver.url, format="teams"), "", message)
    slack, teams = (json.loads(posted.body) for posted in receiver.requests)
    assert "<script>" not in slack["text"]
    assert "&lt;script&gt;" in slack["text"]
    card: dict[str, Any] = teams["attachments"][0]["content"]
    assert card["body"][0]["inlines"][0]["text"] == f"[high] {HOSTILE}"
    assert {block["type"] for block in card["body"]} == {"RichTextBlock"}, "which knows no markup"
