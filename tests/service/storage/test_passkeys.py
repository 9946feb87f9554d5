"""Passkeys, and what counts once, on either database."""

import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from service.storage import NotFoundError, Repository
from service.storage.errors import LastFactorError, PasskeyExistsError
from service.storage.records import NewPasskey, Passkey, Role
from testing.service.accounts import TESTS

NOW_NS = time.time_ns()
CODES = ("a" * 64, "b" * 64)


@pytest.fixture
def passkey(repository: Repository) -> Passkey:
    """Anna's first one."""
    repository.add_user("anna", [Role.VIEWER], password=None, by=TESTS, now_ns=NOW_NS)
    return added(repository, "blue key", "credential-1")


def added(repository: Repository, label: str, credential: str, *, most: int = 3) -> Passkey:
    new = NewPasskey(credential, "a public key", 7)
    return repository.add_passkey(
        "anna", label, new, most=most, codes=CODES, keeps="", by=TESTS, now_ns=NOW_NS
    )[0]


def remove(
    repository: Repository, passkey: Passkey, *, needs_factor: bool = False, user: str = "anna"
) -> None:
    repository.remove_passkey(user, passkey.id, needs_factor=needs_factor, keeps="", by=TESTS, now_ns=NOW_NS)


def test_what_counts_once_counts_for_one_of_many(repository: Repository) -> None:
    for number in range(5):

        def use(_: object, digest: str = f"{number:064}") -> bool:
            return repository.use_once(digest, expires_ns=NOW_NS + 9, now_ns=NOW_NS)

        with ThreadPoolExecutor(4) as pool:
            assert sorted(pool.map(use, range(4))) == [False, False, False, True]
    assert repository.use_once("0" * 64, expires_ns=NOW_NS + 99, now_ns=NOW_NS + 9), "and is then forgotten"


def test_a_counter_goes_on_and_never_back(repository: Repository, passkey: Passkey) -> None:
    for signatures, taken in ((7, False), (0, False), (8, True), (8, False), (2**32 - 1, True)):
        assert repository.use_passkey(passkey.id, signatures, now_ns=NOW_NS) is taken
    with ThreadPoolExecutor(4) as pool:
        silent = added(repository, "phone", "credential-2")
        assert repository.use_passkey(silent.id, 100, now_ns=NOW_NS)
        used = list(pool.map(lambda _: repository.use_passkey(silent.id, 101, now_ns=NOW_NS), range(4)))
    assert sorted(used) == [False, False, False, True]
    remove(repository, silent)
    assert not repository.use_passkey(silent.id, 102, now_ns=NOW_NS)


def test_a_name_a_device_and_a_place_are_taken_once(repository: Repository, passkey: Passkey) -> None:
    for label, credential, most in (
        ("blue key", "credential-2", 3),
        ("phone", "credential-1", 3),
        ("phone", "credential-2", 1),
    ):
        with pytest.raises(PasskeyExistsError):
            added(repository, label, credential, most=most)
    assert repository.passkeys("anna") == [passkey]
    assert repository.passkey_of("anna", "credential-1") == passkey
    assert repository.passkey_of("bert", "credential-1") is None


def test_recovery_codes_come_with_the_first_factor_and_go_with_the_last(
    repository: Repository, passkey: Passkey
) -> None:
    assert repository.use_recovery_code("anna", CODES[0], by=TESTS, now_ns=NOW_NS)
    second = added(repository, "phone", "credential-2")
    assert repository.recovery_codes_left("anna") == 1, "those of before go on"
    with pytest.raises(NotFoundError):
        remove(repository, passkey, user="bert")
    remove(repository, passkey, needs_factor=True)
    with pytest.raises(LastFactorError, match="phone"):
        remove(repository, second, needs_factor=True)
    assert repository.user("anna").has_second_factor
    remove(repository, second)
    assert (repository.user("anna").has_second_factor, repository.recovery_codes_left("anna")) == (False, 0)


def test_an_app_beside_it_stays_the_second_factor(repository: Repository, passkey: Passkey) -> None:
    repository.propose_totp("anna", "sealed", by=TESTS, now_ns=NOW_NS)
    assert repository.confirm_totp("anna", "sealed", 1, codes=CODES, keeps="", by=TESTS, now_ns=NOW_NS)
    remove(repository, passkey, needs_factor=True)
    assert repository.user("anna").has_second_factor
    assert repository.recovery_codes_left("anna") == 2


def test_they_go_with_their_user(repository: Repository, passkey: Passkey) -> None:
    repository.delete_user("anna", by=TESTS, now_ns=NOW_NS)
    assert repository.passkeys("anna") == []


def test_a_provider_ends_what_it_names(repository: Repository) -> None:
    for name in ("anna", "bert"):
        repository.add_user(
            name, [Role.VIEWER], password=None, subject=f"idp {name}", by=TESTS, now_ns=NOW_NS
        )
        for number in range(2):
            repository.begin_session(
                f"{name}{number}",
                name,
                "idp",
                provider_session=f"idp {name}-{number}",
                most=9,
                oldest_ns=0,
                idle_since_ns=0,
                by=TESTS,
                now_ns=NOW_NS,
            )

    def left() -> list[str]:
        digests = ("anna0", "anna1", "bert0", "bert1")
        return [one for one in digests if repository.session_of(one) is not None]

    for subject, login, after in (
        ("idp nobody", None, ["anna0", "anna1", "bert0", "bert1"]),
        ("idp bert", "idp anna-0", ["anna0", "anna1", "bert0", "bert1"]),
        (None, "idp anna-0", ["anna1", "bert0", "bert1"]),
        ("idp bert", "idp bert-1", ["anna1", "bert0"]),
        ("idp anna", None, ["bert0"]),
    ):
        repository.end_at_provider(subject, login, by=TESTS, now_ns=NOW_NS)
        assert left() == after
