"""The collector and simulated relays that want a certificate, a password, or both, over real MMS."""

from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from ied_sim.relay.configuration import Access
from mms import TlsConfiguration
from service.configuration.relay_access import PASSWORD_VARIABLE, RelayAccess, RelayTls
from service.storage.states import LinkState, RecordingRequestState
from testing.relays.pki import Pki
from testing.relays.simulated import Simulated, scenario_of, simulated
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME
from tests.service.collector.session.test_simulated_relays import of

PASSWORD = "OTTER-7-by-the-river"  # noqa: S105
A_DAY = timedelta(days=1)


@pytest.fixture
def pki(tmp_path: Path) -> Pki:
    folder = tmp_path / "pki"
    folder.mkdir()
    return Pki.make(folder)


def relay_tls(tls: TlsConfiguration) -> RelayTls:
    return RelayTls(certificate=tls.certificate, key=tls.key, pinned=tls.pinned, ca=tls.ca)


def password_file(folder: Path, content: str, mode: int = 0o600) -> Path:
    path = folder / "password"
    path.write_text(content + "\n")
    path.chmod(mode)
    return path


def visiting(bench: Bench, served: Simulated, access: RelayAccess) -> Bench:
    """The bench before this relay, with what the settings say of it."""
    return of(bench, served, "EVENTS").with_settings(relays={NAME: access})


def link_reason(bench: Bench) -> str:
    """Why the link is down, once it is."""
    found: list[str] = []

    def is_down() -> bool:
        ied = bench.repository.relay(NAME)
        found.append(ied.link_reason or "")
        return ied.link_state is LinkState.DOWN

    with bench.session():
        assert eventually(is_down)
    return found[-1]


def test_a_record_is_pulled_over_tls_with_a_password(bench: Bench, pki: Pki, tmp_path: Path) -> None:
    scenario = replace(scenario_of("sel-710-ed2"), access=Access(pki.of_relay(), (PASSWORD,)))
    access = RelayAccess(tls=relay_tls(pki.of_client()), password_file=password_file(tmp_path, PASSWORD))
    with simulated(tmp_path / "relays", scenario) as served:
        here = visiting(bench, served, access)
        with here.session() as session:
            assert eventually(lambda: here.link() is LinkState.UP)
            request_id = here.request()
            session.wake()
            assert eventually(lambda: here.requested(request_id).state is RecordingRequestState.FETCHED, 20)
        (recording,) = here.recordings()
        assert recording.digest is not None
        stored = here.store.find(recording.digest)
        made = tmp_path / "relays" / "R1" / "EVENTS"
        assert sorted(file.name for file in here.store.directory(stored.digest).iterdir()) == sorted(
            file.name for file in made.iterdir()
        )
        for file in here.store.directory(stored.digest).iterdir():
            assert file.read_bytes() == (made / file.name).read_bytes()


def test_the_environment_wins_over_the_file(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(f"{PASSWORD_VARIABLE}{NAME}", PASSWORD)
    access = RelayAccess(password_file=password_file(tmp_path, "another"))
    scenario = replace(scenario_of("sel-710-ed2"), access=Access(passwords=(PASSWORD,)))
    with simulated(tmp_path / "relays", scenario) as served:
        here = visiting(bench, served, access)
        with here.session():
            assert eventually(lambda: here.link() is LinkState.UP)


@pytest.mark.parametrize(
    ("shown", "reason"),
    [
        ("no password", "the relay rejects the association: does it want a password?"),
        ("a wrong password", "the relay rejects the association: expected the password it knows"),
        ("an open password file", "expected a file of mode 600, its owner's alone (chmod 600 "),
        ("an empty password file", "expected a password of 1 to 64 printable ASCII characters"),
        ("no TLS", "the relay speaks TLS at this port"),
        ("another certificate", "it does not take our certificate"),
        ("another pin", "the relay's certificate is not trusted: it is none of the pinned ones"),
        ("an open key", "client.key: expected a file of mode 600"),
        ("a missing certificate", "absent.pem: expected a readable file"),
    ],
)
def test_what_keeps_the_link_down_is_its_reason(
    bench: Bench, pki: Pki, tmp_path: Path, shown: str, reason: str
) -> None:
    tls = relay_tls(pki.of_client())
    stored = password_file(tmp_path, PASSWORD)
    access = RelayAccess(tls=tls, password_file=stored)
    match shown:
        case "no password":
            access = RelayAccess(tls=tls)
        case "a wrong password":
            password_file(tmp_path, PASSWORD.lower())
        case "an open password file":
            stored.chmod(0o644)
        case "an empty password file":
            password_file(tmp_path, "")
        case "no TLS":
            access = RelayAccess(password_file=stored)
        case "another certificate":
            other = pki.signed("unpinned", -A_DAY, A_DAY)
            access = RelayAccess(tls=relay_tls(pki.of(other)), password_file=stored)
        case "another pin":
            access = RelayAccess(tls=tls.model_copy(update={"pinned": (tls.certificate,)}))
        case "an open key":
            tls.key.chmod(0o640)
        case "a missing certificate":
            access = RelayAccess(tls=tls.model_copy(update={"pinned": (tmp_path / "absent.pem",)}))
    of_relay = pki.of_relay()
    scenario = replace(scenario_of("sel-710-ed2"), access=Access(of_relay, (PASSWORD,)))
    with simulated(tmp_path / "relays", scenario) as served:
        here = visiting(bench, served, access)
        found = link_reason(here)
    assert reason in found
    assert PASSWORD not in found
    assert PASSWORD.lower() not in found


def test_a_password_in_the_environment_that_is_none_is_not_shown(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(f"{PASSWORD_VARIABLE}{NAME}", f"{PASSWORD}\t")
    found = link_reason(bench)
    assert found == (
        f"environment: {PASSWORD_VARIABLE}{NAME}: expected a password of 1 to 64 printable ASCII characters, "
        "found something else"
    )
