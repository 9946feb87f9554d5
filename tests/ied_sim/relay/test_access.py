"""Simulated relays that do not let everybody in: [motor.access] of a scenario."""

from dataclasses import replace
from pathlib import Path

import pytest

from ied_sim.errors import ScenarioError, SimulatorError
from ied_sim.misbehaviour import Kind, Misbehaviour
from ied_sim.profiles.standalone import standalone
from ied_sim.relay.configuration import Access
from ied_sim.relay.plant_clock import PlantClock
from ied_sim.relay.relay import Relay
from ied_sim.scenario.scenario import read_scenario
from mms import AssociationRejected, Client, MmsError, TlsRequired
from scl import Address
from testing.ports import free_port
from testing.relays.pki import Pki
from testing.relays.simulated import IED, Simulated, scenario_of, simulated
from testing.waiting import wait_until
from tests.ied_sim.scenario.test_scenario import MINIMAL

TLS = 'tls = {certificate = "relay.pem", key = "relay.key", ca = "authority.pem", pinned = ["client.pem"]}'
PASSWORDS = ("OTTER", "TAIL of 7")


def write(folder: Path, access: str, passwords: str = "OTTER\nTAIL of 7\n", mode: int = 0o600) -> Path:
    path = folder / "passwords"
    path.write_text(passwords)
    path.chmod(mode)
    scenario = folder / "scenario.toml"
    scenario.write_text(f"{MINIMAL}[motor.access]\n{access}\n")
    return scenario


def connects(served: Simulated, pki: Pki | None, password: str | None) -> bool:
    address = served.address
    tls = None if pki is None else pki.of_client()
    with Client.connect(address.host, address.port, tls=tls, password=password) as client:
        return client.logical_devices() != []


def test_a_scenario_names_files_relative_to_itself(tmp_path: Path) -> None:
    pki = Pki.make(tmp_path)
    access = read_scenario(write(tmp_path, f'{TLS}\npassword_file = "passwords"'))["R1"].access
    assert access.passwords == PASSWORDS
    assert "OTTER" not in repr(access)
    with simulated(tmp_path / "relays", replace(scenario_of("sel-710-ed2"), access=access)) as served:
        for password in PASSWORDS:
            assert connects(served, pki, password)
        with pytest.raises(AssociationRejected):
            connects(served, pki, "otter")
        with pytest.raises(TlsRequired):
            connects(served, None, "OTTER")


@pytest.mark.parametrize(
    ("access", "passwords", "mode", "message"),
    [
        (TLS, "", 0o600, r"\[motor R1\] access: .*relay\.pem: expected a readable file, found No such"),
        (
            'password_file = "passwords"',
            "OTTER",
            0o640,
            r"passwords: expected a file of mode 600, .*found mode 640",
        ),
        (
            'password_file = "passwords"',
            "OTTER\n\n",
            0o600,
            r"passwords: expected on each line a password of 1 to",
        ),
        ("tls = {certificate = 'a', key = 'b', pinned = []}", "", 0o600, r"access\.tls\.pinned: expected"),
        ("password = 'OTTER'", "", 0o600, r"access\.password: expected no such field"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, access: str, passwords: str, mode: int, message: str) -> None:
    with pytest.raises(ScenarioError, match=message) as refusal:
        read_scenario(write(tmp_path, access, passwords, mode))
    assert "OTTER" not in str(refusal.value)


def test_a_restarted_relay_wants_the_same(tmp_path: Path) -> None:
    pki = Pki.make(tmp_path)
    restart = Misbehaviour(Kind.RESTART, 0.0, at_s=0.0, for_s=0.5)
    scenario = replace(scenario_of("sel-710-ed2", restart), access=Access(pki.of_relay(), PASSWORDS))
    with simulated(tmp_path / "relays", scenario) as served:
        first = served.relay.server

        def is_back() -> bool:
            try:
                return connects(served, pki, "OTTER")
            except MmsError:
                return False

        wait_until(lambda: served.relay.server is not first and is_back(), "the relay to restart")
        with pytest.raises(AssociationRejected):
            connects(served, pki, None)


def test_a_relay_behind_a_front_cannot_have_tls(tmp_path: Path) -> None:
    pki = Pki.make(tmp_path)
    scenario = replace(scenario_of("rdre"), access=Access(pki.of_relay()))
    address = Address("127.0.0.1", free_port())
    document = standalone(scenario.profile, IED, address)
    with pytest.raises(
        SimulatorError, match=r"R1: .*needs a front.*could not read TLS; take another profile"
    ):
        Relay(document, IED, scenario, address=address, files=tmp_path, clock=PlantClock(0))
