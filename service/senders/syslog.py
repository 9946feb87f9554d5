"""Records for a syslog server over UDP (RFC 5426), TCP (RFC 6587) or TLS (RFC 5425).

Syslog has no answers. Over TCP and TLS the connection is closed in order, and the server's own end is waited
for: a server that died meanwhile answers with a reset, and the records are sent again. Nobody knows of a
datagram whether it arrived.
"""

import asyncio
import ssl
from collections.abc import Sequence

from service.configuration.channels import FACILITIES, SyslogChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.syslog_record import SEVERITIES, SyslogRecord, framed
from service.senders.tls import client_context

CLOSING_S = 2.0
"""Servers that do not close their end are not waited for any longer."""


async def send_syslog(channel: SyslogChannel, message: Message) -> None:
    """Send the lines of a message, a record each. Raises SendError."""
    facility = FACILITIES[channel.facility]
    records = [
        SyslogRecord(
            message.created_ns,
            facility,
            SEVERITIES[line.severity],
            "alarm" if line.facts.get("alarm") else "notice",
            line.text,
            {"message": message.id, **line.facts},
        ).octets()
        for line in message.lines
    ]
    await send_records(channel, records)


async def send_records(channel: SyslogChannel, records: Sequence[bytes]) -> None:
    """Send records over one connection. Raises SendError."""
    try:
        if channel.transport == "udp":
            await _send_datagrams(channel, records)
        else:
            await _send_stream(channel, records)
    except (OSError, ssl.SSLError) as error:
        raise SendError(
            f"syslog server {channel.host}:{channel.server_port} ({channel.transport}): {error}"
        ) from error


class _Failures(asyncio.DatagramProtocol):
    """Keeps what the network says of datagrams that nobody takes."""

    def __init__(self) -> None:
        self.failure: OSError | None = None

    def error_received(self, exc: Exception) -> None:
        if isinstance(exc, OSError):
            self.failure = exc


async def _send_datagrams(channel: SyslogChannel, records: Sequence[bytes]) -> None:
    loop = asyncio.get_running_loop()
    transport, failures = await loop.create_datagram_endpoint(
        _Failures, remote_addr=(channel.host, channel.server_port)
    )
    try:
        for record in records:
            transport.sendto(record)
            await asyncio.sleep(0)  # a port that nobody listens at is told between two datagrams
    finally:
        transport.close()
    if failures.failure is not None:
        raise failures.failure


async def _send_stream(channel: SyslogChannel, records: Sequence[bytes]) -> None:
    context = None
    if channel.transport == "tls":
        context = client_context(channel.ca, channel.certificate, channel.key)
    reader, writer = await asyncio.open_connection(channel.host, channel.server_port, ssl=context)
    try:
        for record in records:
            writer.write(framed(record, channel.framing))
            await writer.drain()
        await _closed_in_order(reader, writer)
    finally:
        writer.transport.abort()


async def _closed_in_order(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Close this end and wait for the other one. Raises OSError where the connection breaks instead."""
    if writer.can_write_eof():
        writer.write_eof()
    else:
        writer.close()  # TLS sends what is left, and says that this was all
    try:
        async with asyncio.timeout(CLOSING_S):
            while await reader.read(4096):
                pass
            await writer.wait_closed() if writer.is_closing() else None
    except TimeoutError:
        return
