"""Syslog records as real servers get them."""

import re
import ssl

import pytest

from service.configuration.channels import SyslogChannel
from service.senders.errors import SendError
from service.senders.message import Message
from service.senders.sending import send
from service.senders.syslog_record import LARGEST_BYTES, SyslogRecord
from testing.relays.certificates import Identity
from testing.service.receivers import syslog_server
from testing.waiting import eventually

RECORD = re.compile(
    r"<(?P<priority>\d+)>1 (?P<time>\S+) (?P<host>[!-~]+) statorwatch - (?P<kind>\S+) "
    r'\[statorwatch@32473 (?P<data>(?:[a-z]+="(?:[^"\\\]]|\\["\\\]])*" ?)+)\] \ufeff(?P<text>.*)',
)


def channel(port: int, transport: str, **more: object) -> SyslogChannel:
    given = {"kind": "syslog", "host": "127.0.0.1", "port": port, "transport": transport}
    return SyslogChannel.model_validate({**given, **more})


def check(record: bytes) -> None:
    found = RECORD.fullmatch(record.decode())
    assert found is not None, record
    assert found["priority"] == str(16 * 8 + 3), "local0, err"
    assert found["time"] == "2025-10-09T08:53:20.123456Z"
    assert found["kind"] == "alarm"
    assert found["data"] == r'message="0b1c" alarm="a1" motor="P\"\]\\101"', "nothing ends a value early"
    assert "\n" not in found["text"]
    assert found["text"].endswith("shorted turns")


def test_a_datagram(message: Message) -> None:
    with syslog_server("udp") as server:
        send("siem", channel(server.port, "udp"), "", message)
        assert eventually(lambda: server.received)
    (record,) = server.received
    check(record)


def test_streams_with_either_framing(message: Message) -> None:
    with syslog_server("tcp") as server:
        send("siem", channel(server.port, "tcp"), "", message)
        send("siem", channel(server.port, "tcp", framing="newline"), "", message)
        assert eventually(lambda: len(server.received) == 2)
    counted, line = server.received
    length, _, record = counted.partition(b" ")
    assert int(length) == len(record)
    check(record)
    assert line.endswith(b"\n")
    check(line[:-1])


def test_tls_checks_the_server(message: Message, authority: Identity, server_context: ssl.SSLContext) -> None:
    with syslog_server("tls", server_context) as server:
        send("siem", channel(server.port, "tls", ca=authority.certificate_file), "", message)
        assert eventually(lambda: server.received)
        with pytest.raises(SendError, match="certificate verify failed"):
            send("siem", channel(server.port, "tls"), "", message)
    (octets,) = server.received
    check(octets.partition(b" ")[2])


@pytest.mark.parametrize("transport", ["tcp", "tls"])
def test_a_server_that_is_not_there(message: Message, transport: str) -> None:
    with syslog_server("tcp") as server:
        port = server.port
    with pytest.raises(SendError, match=f"syslog server 127.0.0.1:{port} .{transport}."):
        send("siem", channel(port, transport), "", message)


def test_a_long_text_is_cut_and_stays_text() -> None:
    octets = SyslogRecord(0, 16, 3, "alarm", "µ漢" * 2000, {"motor": "x" * 5000}).octets("host")
    assert LARGEST_BYTES - 4 < len(octets) <= LARGEST_BYTES
    octets.decode()
    name = SyslogRecord(0, 16, 3, "al arm\n", "x").octets("a host\n").split(b" ")
    assert (name[2], name[5]) == (b"a_host_", b"al_arm_")
