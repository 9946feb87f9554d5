"""What runs together ends together."""

import asyncio

import pytest

from service.gateways.mqtt.broker import first_of


def test_who_forgets_that_it_was_cancelled_is_cancelled_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.gateways.mqtt.broker.LOOK_S", 0.01)
    forgotten = []

    async def forgetful() -> None:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            forgotten.append("once")
        await asyncio.Event().wait()

    async def ends() -> None:
        await asyncio.sleep(0)

    asyncio.run(asyncio.wait_for(first_of(forgetful(), ends()), 10))
    assert forgotten == ["once"]
