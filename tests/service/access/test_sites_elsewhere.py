"""Sites of users whom others log in, and of logins at the OPC UA server, which shows the whole plant."""

import asyncio
from collections.abc import Sequence

import pytest
from asyncua.common.utils import ServiceError

from service.access.passwords import hashed
from service.access.proxied import identity_of_proxied
from service.configuration.access import AccessSettings, ProxySettings
from service.gateways.opcua.users import ServiceUsers, has_changed
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

SITES = {"FACTORY_A": ["works-a"], "QUARRY_B": ["works-b"]}
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody


def _proxy(*, sites: bool) -> ProxySettings:
    return ProxySettings.model_validate(
        {
            "addresses": ["192.0.2.10"],
            "user_header": "X-User",
            "roles_header": "X-Groups",
            "roles": {"OPERATOR": ["control-room"]},
            "sites": SITES if sites else None,
        }
    )


@pytest.mark.parametrize(
    ("groups", "told", "expected"),
    [
        ("control-room, works-a", True, frozenset({"FACTORY_A"})),
        ("control-room, works-a, works-b", True, frozenset({"FACTORY_A", "QUARRY_B"})),
        ("control-room", True, frozenset()),
        ("control-room, works-a", False, None),
    ],
)
def test_groups_of_a_proxy_give_sites(
    repository: Repository, groups: str, told: bool, expected: frozenset[str] | None
) -> None:
    headers = {"X-User": ["carl"], "X-Groups": [groups]}

    def values_of(name: str) -> Sequence[str]:
        return headers.get(name, [])

    identity = identity_of_proxied(repository, _proxy(sites=told), values_of)
    assert identity is not None
    assert identity.sites == expected


def test_a_user_whom_a_proxy_logs_in_has_the_sites_that_they_have_here(repository: Repository) -> None:
    repository.add_user("carl", (), password=None, sites=["QUARRY_B"], by=TESTS, now_ns=1)
    headers = {"X-User": ["carl"], "X-Groups": ["control-room, works-a"]}
    for told, expected in ((False, "QUARRY_B"), (True, "FACTORY_A")):
        identity = identity_of_proxied(repository, _proxy(sites=told), lambda name: headers.get(name, []))
        assert identity is not None
        assert identity.sites == frozenset({expected})


def test_groups_of_an_identity_provider_give_sites_and_without_them_those_here_stay(
    repository: Repository,
) -> None:
    def sign_on(sites: Sequence[str] | None) -> frozenset[str] | None:
        return repository.user_of_subject(
            "issuer anna", "anna", [Role.VIEWER], sites=sites, full_name=None, by=TESTS, now_ns=1
        ).sites

    assert sign_on(None) is None
    here = frozenset({"FACTORY_A"})
    assert sign_on(sorted(here)) == here
    assert sign_on(None) == here
    assert sign_on([]) == frozenset(), "no site, not all of them"


def test_the_opc_ua_server_lets_nobody_in_who_has_some_sites(repository: Repository) -> None:
    users = ServiceUsers(repository, AccessSettings(), anonymous=False)
    for name, sites in (("whole", None), ("some", ["FACTORY_A"])):
        repository.add_user(name, [Role.OPERATOR], password=hashed(PASSWORD), sites=sites, by=TESTS, now_ns=1)
        repository.set_password(name, hashed(PASSWORD), by=TESTS, now_ns=2)

    async def log_in(name: str) -> str | None:
        return (await users.log_in(name, PASSWORD, host="192.0.2.7")).account_name

    try:
        assert asyncio.run(log_in("whole")) == "whole"
        with pytest.raises(ServiceError):
            asyncio.run(log_in("some"))
        before = repository.user("whole")
        repository.change_user("whole", sites=["FACTORY_A"], by=TESTS, now_ns=3)
        assert has_changed(repository, before), "a session that is open ends"
    finally:
        users.close()
