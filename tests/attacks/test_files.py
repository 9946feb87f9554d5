"""Another user of the service's machine looks at its files, its processes and its unit."""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from service.client.rest_client import ServiceClient
from service.configuration.relay_access import PASSWORD_VARIABLE
from testing.ports import free_port
from testing.service.processes import (
    FORKED,
    Service,
    descendants,
    link_states,
    running_service,
    simulated_plant,
    switched_off_plant,
    workers_of,
)
from testing.waiting import eventually

pytestmark = pytest.mark.timeout(300)

ROOT = Path(__file__).parents[2]
UNIT = ROOT / "docs" / "how-to" / "deploy" / "statorwatch.service"
NOBODY = 65_534
OTHERS = 0o077
MOST_EXPOSED = 15
"""Of 100: what `systemd-analyze security` may say of the unit."""

SWITCHED_ON = (
    "LockPersonality", "NoNewPrivileges", "PrivateDevices", "PrivateTmp", "PrivateUsers", "ProtectClock",
    "ProtectControlGroups", "ProtectHome", "ProtectHostname", "ProtectKernelLogs", "ProtectKernelModules",
    "ProtectKernelTunables", "RestrictNamespaces", "RestrictRealtime", "RestrictSUIDSGID",
)  # fmt: skip

OF_A_RELAY = "Zx9-of-a-relay-Zx9"
OF_A_CHANNEL = "Qy8-of-a-channel-Qy8"
OF_A_BUCKET = "Wv7-of-a-bucket-Wv7"


def open_files(directory: Path) -> list[str]:
    """What others than the owner may do anything with."""
    return [
        f"{path}: {stat.S_IMODE(path.lstat().st_mode):o}"
        for path in (directory, *directory.rglob("*"))
        if not path.is_symlink() and path.lstat().st_mode & OTHERS
    ]


def read_as_nobody(directory: Path, name: str) -> "subprocess.CompletedProcess[bytes]":
    """Another local user reads a file of this folder, whatever folders above it allow."""
    return subprocess.run(
        ["/bin/cat", name],
        cwd=directory,
        user=NOBODY,
        group=NOBODY,
        extra_groups=[],
        capture_output=True,
        check=False,
    )


def test_a_local_user_reads_the_database(tmp_path: Path) -> None:
    data = tmp_path / "data"
    recording = data / "recordings" / "ab" / "abcd"
    recording.mkdir(parents=True)
    (recording / "C_0001.CFG").write_text("of an earlier version")
    for path in (data, *data.rglob("*")):
        path.chmod(0o755 if path.is_dir() else 0o644)
    tmp_path.chmod(0o755)
    before = os.umask(0o022)
    try:
        with running_service(tmp_path, switched_off_plant(tmp_path)) as service:
            assert (data / "statorwatch.sqlite").is_file()
            assert open_files(data) == []
            if os.geteuid() == 0:
                found = read_as_nobody(tmp_path, "data/statorwatch.sqlite")
                assert found.returncode != 0
                assert b"Permission denied" in found.stderr
            log = service.log.read_text()
    finally:
        os.umask(before)
    assert "files were open to other users and are closed to them now" in log
    assert open_files(data) == [], "what was written until the end"


def test_a_local_user_reads_what_a_command_made_before_the_first_start(tmp_path: Path) -> None:
    data = tmp_path / "data"
    environment = {
        **os.environ,
        "MCC_DATA_DIRECTORY": str(data),
        "MCC_MOTORS": "motors.toml",
    }
    before = os.umask(0o022)
    try:
        subprocess.run(
            [
                sys.executable,
                "-m",
                "service.cli",
                "user",
                "add",
                "anna",
                "--role",
                "VIEWER",
                "--no-password",
                "--local",
            ],
            env=environment,
            check=True,
            capture_output=True,
        )
    finally:
        os.umask(before)
    assert (data / "statorwatch.sqlite").is_file()
    assert open_files(data) == []


def environment_of(process_id: int) -> bytes:
    return Path(f"/proc/{process_id}/environ").read_bytes()


def command_of(process_id: int) -> str:
    return Path(f"/proc/{process_id}/cmdline").read_bytes().replace(b"\0", b" ").decode()


def capabilities_of(process_id: int) -> set[int]:
    """What each thread of a process has, or may get by starting a program."""
    found = set()
    for thread in Path(f"/proc/{process_id}/task").iterdir():
        words = dict(
            line.split(":\t") for line in (thread / "status").read_text().splitlines() if ":\t" in line
        )
        assert words["NoNewPrivs"] == "1", command_of(process_id)
        found |= {int(words[name], 16) for name in ("CapInh", "CapPrm", "CapEff", "CapAmb")}
    return found


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service with a collector, workers and a gateway, and secrets of three kinds in its environment."""
    folder = tmp_path_factory.mktemp("children")
    scenario = folder / "scenario.toml"
    (folder / "password").touch(mode=0o600)
    (folder / "password").write_text(f"{OF_A_RELAY}\n")
    scenario.write_text(
        f'[[motor]]\nied = "A1_SEL710"\n[motor.access]\npassword_file = "{folder / "password"}"\n'
    )
    mail = {"kind": "mail", "host": "127.0.0.1", "user": "mcc", "from": "mcc@plant.example"}
    channels = {"ops": {**mail, "to": ["ops@plant.example"]}}
    settings = {
        f"{PASSWORD_VARIABLE}A1_SEL710": OF_A_RELAY,
        "MCC_NOTIFICATIONS": json.dumps({"channels": channels}),
        "MCC_NOTIFY_PASSWORD_OPS": OF_A_CHANNEL,
        "AWS_SECRET_ACCESS_KEY": OF_A_BUCKET,
        "MCC_GATEWAYS": f'{{"iec104": {{"port": {free_port()}}}}}',
        "MCC_WORKERS": "1",
    }
    with (
        simulated_plant(folder, ("A1_SEL710",), scenario) as plant,
        running_service(folder, plant.scd, **settings) as running,
    ):
        yield running


KINDS = {"acceptor", "collector", "gateway", "parent", "worker"}
"""Of processes of a service: `parent` is that of the workers."""


def children(service: Service) -> Mapping[str, int]:
    """The processes of the service by what they do."""
    kinds = {
        "service.process.acceptor": "acceptor",
        "service.collector": "collector",
        "service.gateways": "gateway",
        FORKED.decode(): "parent",
    }
    workers = workers_of(service.process_id)
    others = {
        kind: process_id
        for process_id in descendants(service.process_id)
        for mark, kind in kinds.items()
        if mark in command_of(process_id) and process_id not in workers
    }
    return {**others, "worker": workers[0]} if workers else others


def test_a_child_reads_secrets_that_are_not_its_own(service: Service) -> None:
    assert eventually(lambda: set(children(service)) == KINDS, 30)
    seen = {
        kind: {
            secret
            for secret in (OF_A_RELAY, OF_A_CHANNEL, OF_A_BUCKET)
            if secret.encode() in environment_of(process_id)
        }
        for kind, process_id in children(service).items()
    }
    assert seen == {
        "collector": {OF_A_RELAY},
        "gateway": set(),
        "parent": set(),
        "worker": set(),
        "acceptor": set(),
    }
    with ServiceClient(service.url) as client:
        assert eventually(lambda: link_states(client)["A1_SEL710"] == "up", 30), "it knows its own"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root has capabilities to give up")
def test_a_child_uses_capabilities_of_the_service(service: Service) -> None:
    assert eventually(lambda: set(children(service)) == KINDS, 30)
    found = {kind: capabilities_of(process_id) for kind, process_id in children(service).items()}
    net_bind_service = 1 << 10
    none = {kind: {0} for kind in ("acceptor", "collector", "parent", "worker")}
    assert found == none | {"gateway": {0, net_bind_service}}


def unit() -> Mapping[str, list[str]]:
    """The settings of the unit, each with its values."""
    settings: dict[str, list[str]] = {}
    for name, value in re.findall(r"^(\w+)=(.*)$", UNIT.read_text(encoding="utf-8"), re.MULTILINE):
        settings.setdefault(name, []).append(value)
    return settings


def test_a_service_under_systemd_is_taken_over() -> None:
    settings = unit()
    for name in SWITCHED_ON:
        assert settings[name] == ["yes"], name
    assert settings["ProtectSystem"] == ["strict"]
    assert settings["CapabilityBoundingSet"] == settings["AmbientCapabilities"] == [""]
    assert settings["User"] == ["statorwatch"]
    assert settings["UMask"] == ["0077"]
    assert settings["StateDirectoryMode"] == settings["CacheDirectoryMode"] == ["0700"]
    assert settings["SystemCallFilter"][:2] == ["@system-service", "~@privileged @resources"]


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed")
def test_systemd_finds_little_exposed() -> None:
    command = [
        "systemd-analyze",
        "security",
        "--offline=true",
        f"--threshold={MOST_EXPOSED}",
        "--no-pager",
        str(UNIT),
    ]
    judged = subprocess.run(command, capture_output=True, text=True, check=False)
    assert judged.returncode == 0, judged.stdout + judged.stderr
