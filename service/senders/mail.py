"""Mail by SMTP: plain text and HTML with its pictures and files, to one address at a time.

One address a mail: a server may take a mail for some addresses and refuse it for others, and whoever has got
it should not get it again.
"""

import asyncio
import contextlib
import socket
import ssl
from datetime import UTC, datetime
from email.headerregistry import Address
from email.message import EmailMessage
from email.policy import SMTP
from email.utils import format_datetime

import aiosmtplib

from core.error_words import one_line
from core.units import NANOSECONDS_PER_SECOND
from service.configuration.channel_secrets import password
from service.configuration.channels import MailChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.tls import client_context

LONGEST_SUBJECT = 200
QUITTING_S = 1.0
PERMANENT = range(500, 600)
AUTHENTICATION = (530, 534, 535, 538)
"""The server refuses the service, not the mail: that can be put right."""


async def send_mail(name: str, channel: MailChannel, recipient: str, message: Message) -> None:
    """Hand a mail to the channel's server. Raises SendError, ChannelSecretError."""
    secret = password(name, channel)
    context = None if channel.security == "none" else client_context(channel.ca)
    client = aiosmtplib.SMTP(
        hostname=channel.host,
        port=channel.server_port,
        use_tls=channel.security == "tls",
        start_tls=False,
        tls_context=context,
        local_hostname=socket.gethostname(),
        timeout=channel.timeout_s,
    )
    connection: asyncio.BaseTransport | None = None
    try:
        await client.connect()
        connection = client.transport
        if channel.security == "starttls":
            await client.starttls(tls_context=context)
        if channel.user is not None and secret is not None:
            await client.login(channel.user, secret)
        await client.sendmail(channel.sender, [recipient], mail_document(channel, recipient, message))
        with contextlib.suppress(aiosmtplib.SMTPException, OSError):
            await client.quit(timeout=QUITTING_S)  # the server has the mail, whatever it says now
    except aiosmtplib.SMTPRecipientsRefused as error:
        refused = error.recipients[0]
        raise _refused(channel, refused.code, refused.message) from error
    except aiosmtplib.SMTPResponseException as error:
        raise _refused(channel, error.code, error.message) from error
    except (aiosmtplib.SMTPException, OSError, ssl.SSLError) as error:
        raise SendError(f"mail server {channel.host}:{channel.server_port}: {error}") from error
    finally:
        client.close()
        if isinstance(connection, asyncio.WriteTransport):
            connection.abort()  # where TLS was refused half-way
        await asyncio.sleep(0)


def mail_document(channel: MailChannel, recipient: str, message: Message) -> bytes:
    """Return the mail as it is sent. No text of a relay or a person can add a header to it."""
    domain = channel.sender.rpartition("@")[2]
    mail = EmailMessage(policy=SMTP.clone(cte_type="7bit"))
    mail["From"] = Address("StatorWatch", addr_spec=channel.sender)
    mail["To"] = Address(addr_spec=recipient)
    mail["Subject"] = one_line(message.subject)[:LONGEST_SUBJECT]
    created = datetime.fromtimestamp(message.created_ns // NANOSECONDS_PER_SECOND, UTC)
    mail["Date"] = format_datetime(created)
    mail["Message-ID"] = f"<{message.id}@{domain}>"
    if message.thread is not None:
        mail["References"] = f"<{message.thread}@{domain}>"
    mail["Auto-Submitted"] = "auto-generated"  # no reply of an absent person comes back (RFC 3834)
    if message.severity in ("critical", "high"):
        mail["Importance"] = "high"
    mail.set_content(message.text)
    if message.html is not None:
        mail.add_alternative(message.html, subtype="html")
        alternatives = mail.get_payload()
        html = alternatives[1]  # type: ignore[index]  # typed as any payload; this one is the list of both
        assert isinstance(html, EmailMessage)  # noqa: S101 - what add_alternative has added
        for key, picture in message.pictures.items():
            html.add_related(
                picture, "image", "png", cid=f"<{key}>", filename=f"{key}.png", disposition="inline"
            )
    for file in message.attachments:
        main, _, sub = file.media_type.partition("/")
        mail.add_attachment(file.content, maintype=main, subtype=sub, filename=file.name)
    return mail.as_bytes()


def _refused(channel: MailChannel, code: int, reason: str) -> SendError:
    return SendError(
        f"mail server {channel.host}:{channel.server_port} answers {code} {one_line(reason)}",
        is_final=code in PERMANENT and code not in AUTHENTICATION,
    )
