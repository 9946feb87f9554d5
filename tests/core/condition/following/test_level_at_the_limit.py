"""A motor whose fault lies at its limit: the state does not turn from record to record."""

from dataclasses import replace

from core.condition.following.follower import Follower
from core.condition.kinds import State
from core.condition.verdict.judging import condition_of
from tests.core.condition.simulated import Plant, follow, motor_of


def test_a_fault_stays_one_at_the_limit_also_after_a_restart() -> None:
    motor, plant = motor_of(), Plant(path=0.0)
    follower = follow(motor, plant.records(40))
    plant.level = 0.02
    for record in plant.records(20):
        follower.fold(record)
    called = follower.assessment()
    assert called is not None
    assert called.change is not None
    # A change that has been surely above its limit is told by a wider interval.
    wider = replace(called.change.level, deviation=0.01, interval=None)
    assert wider.ci95[0] < motor.limits.fault_level < wider.ci95[1]
    restored = Follower.restore(motor, follower.save()).assessment()
    assert restored is not None
    assert restored.change is not None
    at_the_limit = replace(restored, change=replace(restored.change, level=wider))
    condition = condition_of(motor, at_the_limit, 0)
    assert condition.state is State.FAULT
    assert any("stays a fault" in reason for reason in condition.reasons)
    # It was never surely above a limit that is much higher.
    lenient = replace(motor, limits=replace(motor.limits, fault_level=0.03))
    assert condition_of(lenient, at_the_limit, 0).state is State.WATCH
