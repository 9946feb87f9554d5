"""What the page of a motor calls a wound rotor."""

from core.machines.parameters import MachineKind
from service.web.motor.rotor import PARTS


def test_a_wound_rotor_is_no_cage() -> None:
    assert PARTS[MachineKind.WOUND_ROTOR].name == "rotor winding"
    assert all("bar" not in word for word in PARTS[MachineKind.WOUND_ROTOR])
    assert set(PARTS) == set(MachineKind)
