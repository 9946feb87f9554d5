"""ACSE passwords on the loopback interface: the right one, a wrong one, none, over TLS and without."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mms import AssociationRejected, Client, FunctionalConstraint, Server, TlsConfiguration
from mms.security.passwords import LONGEST_PASSWORD, is_password
from testing.ports import LOOPBACK
from testing.relays.pki import Pki
from testing.relays.serving import start_relay

IND01 = "T1PRO/GGIO1.Ind01.stVal"
RIGHT = "TAIL-of-the-bear 7!"


@pytest.fixture
def relay() -> Iterator[Server]:
    with start_relay(passwords=(RIGHT, "OTTER")) as server:
        yield server


def reads(relay: Server, password: str | None, tls: TlsConfiguration | None = None) -> bool:
    with Client.connect(LOOPBACK, relay.port, tls=tls, password=password) as client:
        return client.read(IND01, FunctionalConstraint.ST) is False


@pytest.mark.parametrize("password", [RIGHT, "OTTER"])
def test_the_right_password_lets_in(relay: Server, password: str) -> None:
    assert reads(relay, password)


@pytest.mark.parametrize("password", ["otter", "OTTE", "OTTERS", RIGHT[:-1], "x" * LONGEST_PASSWORD])
def test_a_wrong_password_is_rejected_and_not_told(relay: Server, password: str) -> None:
    with pytest.raises(AssociationRejected, match=r"expected the password it knows") as refusal:
        reads(relay, password)
    assert password not in str(refusal.value)
    assert reads(relay, RIGHT), "it goes on serving the others"


def test_a_missing_password_is_said_so(relay: Server) -> None:
    with pytest.raises(AssociationRejected, match="does it want a password"):
        reads(relay, None)


def test_a_relay_that_wants_none_takes_any() -> None:
    with start_relay() as relay:
        assert reads(relay, "unneeded")


def test_over_tls_the_password_is_told_from_the_certificate(tmp_path: Path) -> None:
    pki = Pki.make(tmp_path)
    with start_relay(tls=pki.of_relay(), passwords=(RIGHT,)) as relay:
        assert reads(relay, RIGHT, pki.of_client())
        with pytest.raises(AssociationRejected, match="expected the password it knows"):
            reads(relay, "OTTER", pki.of_client())
        with pytest.raises(AssociationRejected, match="does it want a password"):
            reads(relay, None, pki.of_client())


@pytest.mark.parametrize("password", ["", "x" * (LONGEST_PASSWORD + 1), "tab\tstop", "nul\0", "Schlüssel"])
def test_what_cannot_be_sent_is_refused_without_showing_it(relay: Server, password: str) -> None:
    with pytest.raises(ValueError, match=f"expected a password of 1 to {LONGEST_PASSWORD}") as refusal:
        reads(relay, password)
    assert not password or password not in str(refusal.value)
    with pytest.raises(ValueError, match="expected a password"):
        start_relay(passwords=(password,))


@settings(max_examples=8, deadline=None)
@given(st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1, max_size=LONGEST_PASSWORD))
def test_every_password_arrives_as_it_is(password: str) -> None:
    assert is_password(password)
    with start_relay(passwords=(password,)) as relay:
        assert reads(relay, password)
