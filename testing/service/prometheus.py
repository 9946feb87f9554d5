"""A Prometheus server for the tests, on a port of its own, gone when its process ends."""

import shutil
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

from testing.ports import LOOPBACK, free_port
from testing.waiting import wait_until


@dataclass(frozen=True, slots=True)
class PrometheusPrograms:
    """The server, and the tool that checks its files."""

    server: str
    promtool: str


def programs() -> PrometheusPrograms | None:
    """The programs of Debian's package prometheus; None without them."""
    server, promtool = shutil.which("prometheus"), shutil.which("promtool")
    return None if server is None or promtool is None else PrometheusPrograms(server, promtool)


class PrometheusServer:
    """A running server."""

    def __init__(self, port: int) -> None:
        self._http = httpx.Client(base_url=f"http://{LOOPBACK}:{port}", trust_env=False, timeout=30)

    def close(self) -> None:
        """Let go of the connections to it."""
        self._http.close()

    def is_ready(self) -> bool:
        """Whether the server can be asked."""
        try:
            return self._http.get("/-/ready").is_success
        except httpx.TransportError:
            return False

    def query(self, expression: str) -> Sequence[Mapping[str, Any]]:
        """What an expression gives now: a list of {"metric": labels, "value": [time, text]}."""
        result = self._data("/api/v1/query", query=expression)["result"]
        assert isinstance(result, list)
        return result

    def alerts(self) -> Sequence[Mapping[str, Any]]:
        """The alerts that fire or are pending, with labels, annotations and state."""
        found = self._data("/api/v1/alerts")["alerts"]
        assert isinstance(found, list)
        return found

    def targets(self) -> Sequence[Mapping[str, Any]]:
        """What it scrapes, with health and latest error."""
        found = self._data("/api/v1/targets")["activeTargets"]
        assert isinstance(found, list)
        return found

    def _data(self, path: str, **query: str) -> Mapping[str, Any]:
        answer = self._http.get(path, params=query)
        document = answer.json()
        assert document["status"] == "success", document
        data = document["data"]
        assert isinstance(data, dict)
        return data


@contextmanager
def serving_prometheus(
    found: PrometheusPrograms, config: Path, directory: Path
) -> Iterator[PrometheusServer]:
    """A server with this configuration that ends with the block, and with this process at the latest."""
    port = free_port()
    words = ["setpriv", "--pdeathsig=KILL", found.server, f"--config.file={config}"]
    words += [f"--storage.tsdb.path={directory / 'data'}", f"--web.listen-address={LOOPBACK}:{port}"]
    with (
        (directory / "log").open("wb") as log,
        subprocess.Popen(words, stdout=log, stderr=log, cwd=directory) as process,
    ):
        server = PrometheusServer(port)
        try:
            wait_until(lambda: process.poll() is not None or server.is_ready(), "Prometheus to answer")
            assert process.poll() is None, (directory / "log").read_text()
            yield server
        finally:
            server.close()
            process.terminate()
            process.wait()
