"""Mails as a real server gets them."""

import ssl
from email.message import EmailMessage
from pathlib import Path

import pytest

from service.configuration.channels import MailChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.sending import send
from testing.relays.certificates import Identity
from testing.service.receivers import mail_server
from tests.service.senders.conftest import PICTURE

TO = "shift@plant.example"


def channel(port: int, **more: object) -> MailChannel:
    given = {
        "kind": "mail",
        "host": "127.0.0.1",
        "port": port,
        "security": "none",
        "from": "mcc@plant.example",
        "to": [TO],
        "timeout_s": 20,
    }
    return MailChannel.model_validate({**given, **more})


def test_a_mail_has_plain_text_and_html_with_its_picture(message: Message) -> None:
    with mail_server() as mailbox:
        send("ops", channel(mailbox.port), TO, message)
    (mail,) = mailbox.mails
    assert mailbox.recipients == [TO]
    plain, html = mail.get_body(("plain",)), mail.get_body(("html",))
    assert isinstance(plain, EmailMessage)
    assert isinstance(html, EmailMessage)
    assert plain.get_content().splitlines()[-2:] == [".", "from the winding"], "no line ends the mail early"
    assert "cid:trend" in html.get_content()
    (picture,) = [part for part in mail.walk() if part.get_content_type() == "image/png"]
    assert picture.get_payload(decode=True) == PICTURE
    assert picture["Content-ID"] == "<trend>"


def test_no_text_of_others_becomes_a_header(message: Message) -> None:
    with mail_server() as mailbox:
        send("ops", channel(mailbox.port), TO, message)
    (mail,) = mailbox.mails
    assert sorted(mail.keys()) == [
        *("Auto-Submitted", "Content-Type", "Date", "From", "Importance", "MIME-Version", "Message-ID"),
        *("References", "Subject", "To"),
    ]
    assert mail["Subject"].startswith("[high] P-101  Bcc: victim@evil.example"), "it is text of the subject"
    assert mail["To"] == TO
    assert mail["Message-ID"] == "<0b1c@plant.example>", "the same at every attempt"
    assert mail["References"] == "<a1@plant.example>"


def test_starttls_and_a_password(
    tmp_path: Path, message: Message, authority: Identity, server_context: ssl.SSLContext
) -> None:
    secret = tmp_path / "password"
    secret.touch(mode=0o600)
    secret.write_text("correct horse\n")
    options = {"security": "starttls", "user": "mcc", "password_file": secret}
    with mail_server(server_context, login=("mcc", "correct horse")) as mailbox:
        send("ops", channel(mailbox.port, ca=authority.certificate_file, **options), TO, message)
        assert len(mailbox.mails) == 1
        with pytest.raises(SendError, match="certificate verify failed"):
            send("ops", channel(mailbox.port, **options), TO, message)
        secret.write_text("wrong battery\n")
        with pytest.raises(SendError, match="535") as refused:
            send("ops", channel(mailbox.port, ca=authority.certificate_file, **options), TO, message)
    assert not refused.value.is_final, "the password can be put right"
    assert "battery" not in str(refused.value)
    assert len(mailbox.mails) == 1


@pytest.mark.filterwarnings("ignore:Requiring AUTH while not requiring TLS")
def test_a_password_from_the_environment_wins_over_a_file_that_others_can_read(
    tmp_path: Path, message: Message, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = tmp_path / "password"
    secret.write_text("open secret")
    secret.chmod(0o644)
    with mail_server(login=("mcc", "pass word")) as mailbox:
        wanted = channel(mailbox.port, user="mcc", password_file=secret)
        with pytest.raises(SendError, match="password") as refused:
            send("night-shift", wanted, TO, message)
        assert "open secret" not in str(refused.value)
        monkeypatch.setenv("MCC_NOTIFY_PASSWORD_NIGHT_SHIFT", "pass word")
        send("night-shift", wanted, TO, message)
    assert len(mailbox.mails) == 1


@pytest.mark.parametrize(("reply", "is_final"), [("451 later", False), ("554 never", True)])
def test_a_refusal_says_whether_to_try_again(message: Message, reply: str, is_final: bool) -> None:
    with mail_server() as mailbox:
        mailbox.replies = [reply]
        with pytest.raises(SendError, match=reply) as refused:
            send("ops", channel(mailbox.port), TO, message)
        mailbox.refused = {TO: f"{reply[:3]} not this one"}
        with pytest.raises(SendError, match="not this one") as refused_address:
            send("ops", channel(mailbox.port), TO, message)
    assert (refused.value.is_final, refused_address.value.is_final) == (is_final, is_final)


def test_a_server_that_says_nothing_is_given_up_in_time(message: Message) -> None:
    with mail_server() as mailbox:
        mailbox.answers.clear()
        with pytest.raises(SendError, match=r"no answer within 0\.5 s|127\.0\.0\.1"):
            send("ops", channel(mailbox.port, timeout_s=0.5), TO, message)


def test_no_server_at_all(message: Message) -> None:
    with mail_server() as mailbox:
        port = mailbox.port
    with pytest.raises(SendError, match=f"mail server 127.0.0.1:{port}"):
        send("ops", channel(port), TO, message)
