"""docs/reference/roles.md has every permission and every route with the roles that may use it."""

from service.access.permissions import MEANINGS, Permission
from service.storage.records import Role
from tests.docs.role_tables import PAGE, written


def test_the_tables_are_those_of_the_code() -> None:
    assert list(MEANINGS) == list(Permission)
    page = PAGE.read_text(encoding="utf-8")
    assert page == written(page), "routes or roles have changed: run `make docs` and commit the page"


def test_every_role_is_told() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert all(f"| `{role}` |" in page for role in Role)
