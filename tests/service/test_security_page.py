"""docs/how-to/security.md: its commands make certificates, its settings use them, its exchange works."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from mms import Client, RelayNotTrusted, Server, TlsConfiguration
from service.configuration.relay_access import credentials
from service.configuration.settings import Settings
from testing.ports import LOOPBACK
from testing.relays.serving import start_relay

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "security.md").read_text(encoding="utf-8")
RELAY = "A1_SEL710"
PASSWORD = "TAIL-7"  # noqa: S105

pytestmark = pytest.mark.skipif(shutil.which("openssl") is None, reason="needs the command openssl")


def block(language: str) -> str:
    """The first of the page in this language: another one has a list of revoked certificates beside it."""
    return str(re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)[0])


@pytest.fixture
def config(tmp_path: Path) -> Path:
    """The page's settings file with the files it names, made by the page's commands."""
    certificates, secrets = tmp_path / "certificates", tmp_path / "secrets"
    certificates.mkdir()
    secrets.mkdir()
    subprocess.run(
        ["sh", "-e"], input=block("sh"), cwd=certificates, check=True, capture_output=True, text=True
    )
    (secrets / RELAY).touch(mode=0o600)
    (secrets / RELAY).write_text(f"{PASSWORD}\n")
    path = tmp_path / "mcc.toml"
    path.write_text(block("toml"))
    return path


def served(folder: Path, side: str = RELAY) -> Server:
    tls = TlsConfiguration(
        certificate=folder / f"{side}.pem",
        key=folder / f"{side}.key",
        pinned=(folder / "mcc.pem",),
        ca=folder / "authority.pem",
    )
    return start_relay(tls=tls, passwords=(PASSWORD,))


def connects(config: Path, relay: Server) -> bool:
    shown = credentials(Settings.load(config).relays, RELAY)
    assert shown.tls is not None
    with Client.connect(LOOPBACK, relay.port, tls=shown.tls, password=shown.spoken_password) as client:
        return client.logical_devices() != []


def test_the_pages_commands_and_settings_make_a_connection(config: Path) -> None:
    access = Settings.load(config).relays[RELAY]
    assert access.tls is not None
    assert access.tls.port == 3782
    with served(config.parent / "certificates") as relay:
        assert connects(config, relay)


def test_a_relays_certificate_is_exchanged_without_a_restart(config: Path) -> None:
    folder = config.parent / "certificates"
    again = block("sh").replace("in mcc A1_SEL710", "in newer").partition("# The service and the relay")[2]
    again = again.partition("\n")[2].partition("chmod")[0]
    subprocess.run(["sh", "-e"], input=again, cwd=folder, check=True, capture_output=True, text=True)
    with served(folder, "newer") as relay:
        with pytest.raises(RelayNotTrusted):
            connects(config, relay)
        with (folder / f"{RELAY}.pem").open("a") as pinned:
            pinned.write((folder / "newer.pem").read_text())
        assert connects(config, relay)
