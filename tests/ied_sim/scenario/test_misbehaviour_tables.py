"""When misbehaviour is on, and what is said of tables that describe none."""

from pathlib import Path

import pytest

from ied_sim.errors import ScenarioError, SimulatorError
from ied_sim.misbehaviour import Kind, Misbehaviour, MisbehaviourState
from ied_sim.scenario.scenario import read_scenario
from testing.relays.simulated import scenario_of, simulated
from tests.ied_sim.scenario.test_scenario import MINIMAL

SWITCH = "CON/RBGGIO1.SPCSO30"


def test_time_switches_too() -> None:
    now = [0.0]
    timed = Misbehaviour(Kind.FROZEN, at_s=10.0, for_s=5.0, switch=SWITCH)
    board = MisbehaviourState([timed, Misbehaviour(Kind.SLOW_REPLIES, 2.0, at_s=0.0)], lambda: now[0])
    seen = []
    for now[0] in (9.9, 10.0, 14.9, 15.0):
        seen.append(board.is_on(Kind.FROZEN))
    assert seen == [False, True, True, False]
    board.switch(SWITCH, on=True)
    assert board.is_on(Kind.FROZEN)
    board.switch(SWITCH, on=False)
    assert not board.is_on(Kind.FROZEN)
    assert board.number(Kind.SLOW_REPLIES) == 2.0


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ('kind = "slow"', r"misbehaviour.0.kind: expected 'slow-replies', "),
        ('kind = "frozen"\ndelay_s = 2', r"misbehaviour.0: expected frozen has no delay_s"),
        ('kind = "slow-replies"\ndelay_s = 0', r"misbehaviour.0.delay_s: expected greater than 0"),
        ('kind = "frozen"\nswitch = "RB30"', r"misbehaviour.0.switch"),
    ],
)
def test_what_is_wrong_with_a_misbehaviour_is_named(tmp_path: Path, lines: str, message: str) -> None:
    path = tmp_path / "scenario.toml"
    path.write_text(f"{MINIMAL}[[motor.misbehaviour]]\n{lines}\n", encoding="utf-8")
    with pytest.raises(ScenarioError, match=message):
        read_scenario(path)


def test_a_scenario_s_misbehaviour_has_its_number(tmp_path: Path) -> None:
    path = tmp_path / "scenario.toml"
    lines = '[[motor.misbehaviour]]\nkind = "slow-replies"\n[[motor.misbehaviour]]\nkind = "few-sessions"\n'
    path.write_text(f"{MINIMAL}{lines}sessions = 3\nat_s = 4\n", encoding="utf-8")
    slow, few = read_scenario(path)["R1"].misbehaviour
    assert slow == Misbehaviour(Kind.SLOW_REPLIES, 2.0, at_s=0.0)
    assert few == Misbehaviour(Kind.FEW_SESSIONS, 3.0, at_s=4.0)


def test_a_switch_the_relay_lacks_is_refused(tmp_path: Path) -> None:
    lost = Misbehaviour(Kind.FROZEN, switch="CON/RBGGIO1.SPCSO99")
    with (
        pytest.raises(SimulatorError, match=r"R1CON/RBGGIO1\.SPCSO99 is no control of this relay"),
        simulated(tmp_path, scenario_of("sel-710-ed2", lost)),
    ):
        pass
