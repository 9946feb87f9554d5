from service.access.permissions import PERMISSIONS_OF, Permission, permissions_of, roles_with
from service.storage.records import Role


def test_every_permission_is_held_by_some_role_and_every_role_has_some() -> None:
    assert set(PERMISSIONS_OF) == set(Role)
    assert all(roles_with(permission) for permission in Permission)
    assert permissions_of(Role) == frozenset(Permission)


def test_those_who_manage_users_or_read_the_audit_trail_do_not_operate_the_plant() -> None:
    operating = PERMISSIONS_OF[Role.ENGINEER] - {Permission.ACCOUNT}
    assert not operating & (PERMISSIONS_OF[Role.SECADM] | PERMISSIONS_OF[Role.SECAUD])
    assert PERMISSIONS_OF[Role.SECADM] & PERMISSIONS_OF[Role.SECAUD] == {Permission.ACCOUNT}


def test_an_engineer_may_do_what_an_operator_may_who_may_do_what_a_viewer_may() -> None:
    assert PERMISSIONS_OF[Role.VIEWER] < PERMISSIONS_OF[Role.OPERATOR] < PERMISSIONS_OF[Role.ENGINEER]
