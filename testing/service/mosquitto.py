"""An MQTT broker and clients that are not ours: Debian's mosquitto."""

import os
import shutil
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Thread
from typing import IO, NamedTuple

from testing.not_installed import not_installed
from testing.ports import LOOPBACK, free_port
from testing.waiting import wait_until

PATH = f"{os.environ.get('PATH', '')}:/usr/sbin"


def program(name: str) -> str:
    """The path of one of mosquitto's programs; a test that needs it fails in CI without it."""
    found = shutil.which(name, path=PATH)
    if found is None:
        not_installed(f"no {name}: apt-get install --no-install-recommends mosquitto mosquitto-clients")
    return found


class Heard(NamedTuple):
    """A message as mosquitto_sub writes it."""

    topic: str
    is_retained: bool
    payload: bytes


@dataclass
class Mosquitto:
    """A broker that can be stopped and started again. settings: lines of its configuration file."""

    directory: Path
    settings: Sequence[str] = ("allow_anonymous true",)
    client_options: Sequence[str] = ()
    port: int = field(default_factory=free_port)
    _process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start it; return when it answers."""
        file = self.directory / "mosquitto.conf"
        lines = [f"listener {self.port} {LOOPBACK}", "user root", *self.settings]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        with (self.directory / "mosquitto.log").open("ab") as log:
            self._process = subprocess.Popen([program("mosquitto"), "-c", file], stdout=log, stderr=log)
        wait_until(self._answers, "mosquitto to answer")

    def stop(self) -> None:
        """Stop it, and lose what it kept."""
        process, self._process = self._process, None
        if process is not None:
            process.terminate()
            process.wait(timeout=30)

    @contextmanager
    def hanging(self) -> Iterator[None]:
        """Let it say nothing for the time of the block; its connections stay."""
        assert self._process is not None
        self._process.send_signal(signal.SIGSTOP)
        try:
            yield
        finally:
            self._process.send_signal(signal.SIGCONT)

    def publish(self, topic: str, payload: bytes, *, retain: bool = False) -> None:
        """Publish a message by mosquitto_pub. retain: the broker keeps it."""
        kept = ("-r",) if retain else ()
        command = [program("mosquitto_pub"), *self._client(), "-t", topic, "-q", "1", *kept, "-s"]
        subprocess.run(command, input=payload, check=True, timeout=30)

    @contextmanager
    def listening(self, *filters: str) -> Iterator[list[Heard]]:
        """Listen by mosquitto_sub; the list grows with what is heard."""
        heard: list[Heard] = []
        topics = [option for one in filters for option in ("-t", one)]
        command = [program("mosquitto_sub"), *self._client(), *topics, "-q", "1", "-F", "%t\t%r\t%x"]
        with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
            assert process.stdout is not None
            reader = Thread(target=_read, args=(process.stdout, heard), daemon=True)
            reader.start()
            try:
                yield heard
            finally:
                process.terminate()
                reader.join(timeout=30)

    def _client(self) -> Sequence[str]:
        return ["-h", LOOPBACK, "-p", str(self.port), *self.client_options]

    def _answers(self) -> bool:
        # An answer to a subscription, whatever is heard, and an exit by itself.
        command = [program("mosquitto_sub"), *self._client(), "-t", "none", "-E"]
        return subprocess.run(command, check=False, timeout=30, capture_output=True).returncode == 0


def _read(output: IO[bytes], heard: list[Heard]) -> None:
    for line in output:
        topic, retained, payload = line.rstrip(b"\n").split(b"\t")
        heard.append(Heard(topic.decode(), retained == b"1", bytes.fromhex(payload.decode())))


@contextmanager
def running_mosquitto(
    directory: Path, *settings: str, client_options: Sequence[str] = (), port: int | None = None
) -> Iterator[Mosquitto]:
    """Run a broker on loopback, without passwords unless its settings say otherwise."""
    chosen = settings or ("allow_anonymous true",)
    broker = Mosquitto(directory, chosen, client_options, free_port() if port is None else port)
    broker.start()
    try:
        yield broker
    finally:
        broker.stop()
