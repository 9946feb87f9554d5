"""Receivers of messages for tests: a mail server, an HTTP server, a syslog server; all on free ports."""

import asyncio
import socket
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from email import message_from_bytes
from email.message import EmailMessage
from email.policy import default
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from aiosmtpd.controller import Controller
from aiosmtpd.smtp import SMTP, AuthResult, Envelope, LoginPassword, Session

from testing.ports import free_port


@dataclass
class Mailbox:
    """The mails that a server took. replies: what it answers to the next mails instead of taking them."""

    port: int = 0
    mails: list[EmailMessage] = field(default_factory=list)
    recipients: list[str] = field(default_factory=list)
    replies: list[str] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)
    took: threading.Event = field(default_factory=threading.Event)
    answers: threading.Event = field(default_factory=threading.Event)
    """Cleared: the server takes a mail and does not say so until it is set."""

    async def handle_RCPT(
        self, _server: SMTP, _session: Session, envelope: Envelope, address: str, _options: list[str]
    ) -> str:
        if address in self.refused:
            return self.refused[address]
        envelope.rcpt_tos.append(address)
        return "250 OK"

    async def handle_DATA(self, _server: SMTP, _session: Session, envelope: Envelope) -> str:
        if self.replies:
            return self.replies.pop(0)
        content = envelope.content
        assert isinstance(content, bytes)
        mail = message_from_bytes(content, policy=default)
        assert isinstance(mail, EmailMessage)
        self.mails.append(mail)
        self.recipients.extend(envelope.rcpt_tos)
        self.took.set()
        while not self.answers.is_set():
            await asyncio.sleep(0.01)
        return "250 OK"


@contextmanager
def mail_server(
    context: ssl.SSLContext | None = None, *, login: tuple[str, str] | None = None
) -> Iterator[Mailbox]:
    """A mail server at 127.0.0.1. context: it asks for STARTTLS.  login: name and password it asks for."""
    mailbox = Mailbox(free_port())
    mailbox.answers.set()

    def authenticate(*told: object) -> AuthResult:
        *_, data = told
        assert isinstance(data, LoginPassword)
        given = (data.login.decode(), data.password.decode())
        return AuthResult(success=given == login, handled=False)

    controller = Controller(
        mailbox,
        hostname="127.0.0.1",
        port=mailbox.port,
        tls_context=context,
        require_starttls=context is not None,
        auth_required=login is not None,
        auth_require_tls=context is not None,
        authenticator=authenticate,
    )
    controller.start()
    try:
        yield mailbox
    finally:
        mailbox.answers.set()
        controller.stop()


@dataclass
class Posted:
    """A request that an HTTP server got."""

    path: str
    headers: dict[str, str]
    body: bytes


@dataclass
class HttpReceiver:
    """The requests that a server got. statuses: what it answers to the next ones, then 200."""

    port: int = 0
    requests: list[Posted] = field(default_factory=list)
    statuses: list[int] = field(default_factory=list)
    location: str | None = None
    took: threading.Event = field(default_factory=threading.Event)
    answers: threading.Event = field(default_factory=threading.Event)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/hook"


@contextmanager
def http_receiver() -> Iterator[HttpReceiver]:
    """An HTTP server at 127.0.0.1 that takes what is posted."""
    receiver = HttpReceiver()
    receiver.answers.set()

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            headers = {name.lower(): value for name, value in self.headers.items()}
            receiver.requests.append(Posted(self.path, headers, body))
            receiver.took.set()
            receiver.answers.wait(60)
            self.send_response(receiver.statuses.pop(0) if receiver.statuses else 200)
            if receiver.location is not None:
                self.send_header("Location", receiver.location)
            self.send_header("Content-Length", "0")
            self.end_headers()

        def log_message(self, *_arguments: object) -> None:
            """Print nothing."""

        def handle(self) -> None:
            try:
                super().handle()
            except OSError:
                return  # whoever asked is gone

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    receiver.port = server.server_address[1]
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    try:
        yield receiver
    finally:
        receiver.answers.set()
        server.shutdown()
        thread.join()
        server.server_close()


@dataclass
class SyslogReceiver:
    """What a syslog server got: a connection's octets, or a datagram, each."""

    port: int = 0
    received: list[bytes] = field(default_factory=list)


@contextmanager
def syslog_server(transport: str, context: ssl.SSLContext | None = None) -> Iterator[SyslogReceiver]:
    """A syslog server at 127.0.0.1: "udp", "tcp", or "tls" with a context."""
    receiver = SyslogReceiver()
    kind = socket.SOCK_DGRAM if transport == "udp" else socket.SOCK_STREAM
    with socket.socket(socket.AF_INET, kind) as listener:
        listener.bind(("127.0.0.1", 0))
        receiver.port = listener.getsockname()[1]
        if transport != "udp":
            listener.listen()
        listener.settimeout(0.05)
        ending = threading.Event()
        work = _datagrams if transport == "udp" else _connections
        thread = threading.Thread(target=work, args=(listener, receiver, ending, context))
        thread.start()
        try:
            yield receiver
        finally:
            ending.set()
            thread.join()


def _datagrams(
    listener: socket.socket, receiver: SyslogReceiver, ending: threading.Event, _context: object
) -> None:
    while not ending.is_set():
        try:
            receiver.received.append(listener.recv(65_536))
        except TimeoutError:
            continue


def _connections(
    listener: socket.socket,
    receiver: SyslogReceiver,
    ending: threading.Event,
    context: ssl.SSLContext | None,
) -> None:
    while not ending.is_set():
        try:
            connection, _ = listener.accept()
        except TimeoutError:
            continue
        connection.settimeout(10)
        try:
            spoken = connection if context is None else context.wrap_socket(connection, server_side=True)
        except ssl.SSLError:
            connection.close()
            continue
        with spoken:
            octets = b""
            while read := spoken.recv(65_536):
                octets += read
            receiver.received.append(octets)
