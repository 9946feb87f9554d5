"""What a relay measures all the time, sampled over real MMS."""

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from threading import Thread

import pytest

import scl
from core.units import NANOSECONDS_PER_SECOND
from mms import (
    AccessDenied,
    Client,
    ConnectionLost,
    DataAccessError,
    FunctionalConstraint,
    MmsError,
    NotFound,
    ProtocolError,
    RequestRejected,
    Server,
    ServiceFailed,
    Value,
)
from scl.model_text import model_text
from service.collector.session.browsing import browse
from service.collector.session.metering import MOST_TOGETHER, Metering
from service.collector.session.relay_session import RelaySession
from service.plant import Measurand, MeteredQuantity, Relay
from service.plant.metering import measurands_from_offer, measurands_from_scl
from service.storage.records import Sample
from testing.waiting import eventually
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

MMXU = f"{NAME}MET/METMMXU1"
CURRENT_A = 7.25
FREQUENCY_HZ = 49.98


@pytest.fixture
def metered(bench: Bench, relay: ScriptedRelay) -> Relay:
    """The relay as its SCL describes it, with two values set."""
    relay.server.update_many(
        {f"{MMXU}.A.phsA.cVal.mag.f": CURRENT_A, f"{MMXU}.Hz.mag.f": FREQUENCY_HZ},
    )
    return replace(bench.relay, measurands=measurands_from_scl(scl.read(scl.DEMO_PLANT_SCD).ied(NAME)))


def test_the_model_says_what_a_relay_measures() -> None:
    found = {
        each.quantity: each.reference for each in measurands_from_scl(scl.read(scl.DEMO_PLANT_SCD).ied(NAME))
    }
    assert found[MeteredQuantity.IA] == f"{MMXU}.A.phsA.cVal.mag.f"
    assert found[MeteredQuantity.FREQUENCY] == f"{MMXU}.Hz.mag.f"
    assert {quantity.value for quantity in found} >= {
        *("ia_A", "ib_A", "ic_A", "vab_V", "vbc_V", "vca_V"),
        *("power_W", "reactive_power_var", "power_factor", "frequency_Hz"),
    }


def test_values_are_sampled_at_their_period(bench: Bench, metered: Relay) -> None:
    samples: list[Sample] = []
    metering = Metering(metered, MOTOR, period_s=0.2, on_sample=samples.append)
    assert metering.due_in_s() == 0
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.begin()
        metering.sample(client)
        assert 0 < metering.due_in_s() <= 0.2
    (sample,) = samples
    assert sample.motor == MOTOR
    assert abs(time.time_ns() - sample.time_ns) < 10e9
    assert sample.values["ia_A"] == pytest.approx(CURRENT_A)
    assert sample.values["frequency_Hz"] == pytest.approx(FREQUENCY_HZ)


def test_what_the_relay_lacks_is_left_out(bench: Bench, metered: Relay) -> None:
    missing = Measurand(MeteredQuantity.VA, f"{MMXU}.PhV.phsX.cVal.mag.f", None)
    bogus = Measurand(MeteredQuantity.VB, f"{NAME}XXX/METMMXU9.Hz.mag.f", None)
    samples: list[Sample] = []
    some = replace(metered, measurands=(missing, bogus, metered.measurands[0]))
    metering = Metering(some, MOTOR, period_s=60, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.sample(client)
    assert dict(samples[0].values) == {"ia_A": pytest.approx(CURRENT_A)}


@pytest.mark.parametrize(
    "refusal",
    [
        DataAccessError.HARDWARE_FAULT,
        DataAccessError.TYPE_INCONSISTENT,
        DataAccessError.VALUE_INVALID,
        DataAccessError.ACCESS_DENIED,
        DataAccessError.TEMPORARILY_UNAVAILABLE,
    ],
)
def test_a_value_that_is_refused_ends_no_sample(
    bench: Bench, relay: ScriptedRelay, metered: Relay, refusal: DataAccessError
) -> None:
    samples: list[Sample] = []
    metering = Metering(metered, MOTOR, period_s=60, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.begin()
        for refused in (True, False, True):
            relay.unreadable = {f"{MMXU}.A": refusal} if refused else {}
            metering.sample(client)
        relay.unreadable.clear()
        metering.begin()
        metering.sample(client)
    assert ["ia_A" in sample.values for sample in samples] == [
        False,
        refusal is not DataAccessError.ACCESS_DENIED,  # which is refused for the length of a connection
        False,
        True,
    ]
    assert all(sample.values["frequency_Hz"] == pytest.approx(FREQUENCY_HZ) for sample in samples)


def test_a_power_of_ten_that_is_refused_is_not_guessed(
    bench: Bench, relay: ScriptedRelay, metered: Relay
) -> None:
    """The relay's model has none for currents: an object that is refused stands for it."""
    current = next(each for each in metered.measurands if each.quantity is MeteredQuantity.IA)
    scaled = replace(current, multiplier=f"{MMXU}.Hz.units.multiplier")
    relay.unreadable = {f"{MMXU}.Hz": DataAccessError.HARDWARE_FAULT}
    samples: list[Sample] = []
    metering = Metering(replace(metered, measurands=(scaled,)), MOTOR, period_s=60, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.sample(client)
    assert samples == []


def test_a_malformed_answer_ends_the_visit(
    bench: Bench, metered: Relay, monkeypatch: pytest.MonkeyPatch
) -> None:
    def malformed(client: Client, reference: str, constraint: FunctionalConstraint) -> Value:
        raise ProtocolError(client.host, f"read {reference}", 34, "malformed message")

    samples: list[Sample] = []
    metering = Metering(metered, MOTOR, period_s=60, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        monkeypatch.setattr(Client, "read", malformed)
        monkeypatch.setattr(Client, "read_together", malformed)
        with pytest.raises(ProtocolError, match="malformed"):
            metering.sample(client)


def requests_counted(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each service of a client is asked for from now on."""
    asked: Counter[str] = Counter()
    for name in ("read", "read_together"):
        right = getattr(Client, name)

        def counting(
            client: Client, *given: object, name: str = name, right: Callable[..., object] = right
        ) -> object:
            asked[name] += 1
            return right(client, *given)

        monkeypatch.setattr(Client, name, counting)
    return asked


def test_all_values_of_a_device_come_with_one_request(
    bench: Bench, metered: Relay, monkeypatch: pytest.MonkeyPatch
) -> None:
    samples: list[Sample] = []
    metering = Metering(metered, MOTOR, period_s=60, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.sample(client)  # it also reads powers of ten
        asked = requests_counted(monkeypatch)
        metering.sample(client)
    assert 1 < len(metered.measurands) <= MOST_TOGETHER
    assert asked == {"read_together": 1}
    assert dict(samples[0].values) == dict(samples[1].values)


@pytest.mark.parametrize("refusal", [ServiceFailed, RequestRejected, AccessDenied, NotFound])
def test_a_relay_that_refuses_many_values_at_once_gives_them_one_by_one(
    bench: Bench, metered: Relay, monkeypatch: pytest.MonkeyPatch, refusal: type[MmsError]
) -> None:
    def refuse(client: Client, *_: object) -> Value:
        asked["refused"] += 1
        raise refusal(client.host, "read 12 values", 1, "no lists")

    samples: list[Sample] = []
    metering = Metering(metered, MOTOR, period_s=60, on_sample=samples.append)
    asked = requests_counted(monkeypatch)
    monkeypatch.setattr(Client, "read_together", refuse)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.sample(client)
        metering.begin()
        metering.sample(client)
    assert asked["refused"] == 1
    assert [sample.values["ia_A"] for sample in samples] == [pytest.approx(CURRENT_A)] * 2


@pytest.mark.parametrize("has_worked", [False, True])
def test_a_relay_whose_link_ends_at_its_first_request_of_many_values_is_asked_so_once(
    bench: Bench, metered: Relay, monkeypatch: pytest.MonkeyPatch, has_worked: bool
) -> None:
    def lose(client: Client, *_: object) -> Value:
        raise ConnectionLost(client.host, "read 12 values", 2, "the link is gone")

    samples: list[Sample] = []
    metering = Metering(metered, MOTOR, period_s=60, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        if has_worked:
            metering.sample(client)
        with monkeypatch.context() as lost:
            lost.setattr(Client, "read_together", lose)
            with pytest.raises(ConnectionLost):
                metering.sample(client)
    asked = requests_counted(monkeypatch)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.begin()
        metering.sample(client)
    assert ("read_together" in asked) == has_worked
    assert samples[-1].values["ia_A"] == pytest.approx(CURRENT_A)


def test_a_relay_that_measures_nothing_is_not_asked_again(bench: Bench, metered: Relay) -> None:
    bogus = Measurand(MeteredQuantity.VB, f"{NAME}XXX/METMMXU9.Hz.mag.f", None)
    samples: list[Sample] = []
    metering = Metering(replace(metered, measurands=(bogus,)), MOTOR, period_s=0.1, on_sample=samples.append)
    with Client.connect("127.0.0.1", metered.port) as client:
        metering.sample(client)
    assert samples == []
    assert metering.due_in_s() > 1e9
    metering.begin()
    assert metering.due_in_s() == 0, "another connection, another chance"
    switched_off = Metering(metered, MOTOR, period_s=0, on_sample=samples.append)
    assert switched_off.due_in_s() > 1e9


MSTA_NODE = '<LN prefix="MET" lnClass="MSTA" inst="1" lnType="MSTA"/>'
MSTA_TYPE = """<LNodeType id="MSTA" lnClass="MSTA"><DO name="Beh" type="ENS_Beh"/>
    <DO name="AvAmps" type="MV_W"/><DO name="MaxW" type="MV_W"/><DO name="MaxA" type="WYE_A"/></LNodeType>
    <LNodeType id="MSQI" """


def test_statistics_are_sampled_where_the_relay_has_them(tmp_path: Path, bench: Bench) -> None:
    """Once a minute at most; in the relay's own model or in its SCL, both lead there."""
    text = scl.DEMO_PLANT_SCD.read_text(encoding="utf-8").replace('<LNodeType id="MSQI" ', MSTA_TYPE)
    path = tmp_path / "statistics.scd"
    path.write_text(
        text.replace('<LN prefix="MET" lnClass="MSQI"', MSTA_NODE + '<LN prefix="MET" lnClass="MSQI"')
    )
    document = scl.read(path)
    msta = f"{NAME}MET/METMSTA1"
    statistics = {"average_current_A": 5.5, "maximum_power_W": 810.0, "maximum_ib_A": 11.5}
    promised = {each for each in measurands_from_scl(document.ied(NAME)) if each.quantity.is_statistic}
    assert {each.quantity for each in promised} == {*statistics, "maximum_ia_A", "maximum_ic_A"}
    server = Server(model_text(document, NAME), port=bench.relay.port)
    server.start()
    try:
        server.update_many(
            {
                f"{msta}.AvAmps.mag.f": 5.5,
                f"{msta}.MaxW.mag.f": 810.0,
                f"{msta}.MaxA.phsB.cVal.mag.f": 11.5,
            }
        )
        samples: list[Sample] = []
        with Client.connect("127.0.0.1", bench.relay.port) as client:
            offer = browse(client, None)
            assert offer is not None
            found = measurands_from_offer(offer, ())
            assert promised <= set(found)
            metering = Metering(bench.relay, MOTOR, period_s=60, on_sample=samples.append)
            metering.begin(found)
            metering.sample(client)
            metering.sample(client)
    finally:
        server.stop()
    first, second = (
        {name: value for name, value in each.values.items() if name in statistics} for each in samples
    )
    assert first == pytest.approx(statistics)
    assert second == {}
    assert "frequency_Hz" in samples[1].values


def test_a_session_samples_while_it_waits(bench: Bench, relay: ScriptedRelay, metered: Relay) -> None:
    samples: list[Sample] = []
    settings = bench.settings.model_copy(update={"metering_period_s": 0.1, "poll_period_s": 60.0})
    session = RelaySession(metered, MOTOR, bench.repository, bench.store, settings, on_sample=samples.append)
    thread = Thread(target=session.run)
    started_ns = time.time_ns()
    thread.start()
    try:
        assert eventually(lambda: len(samples) >= 5)
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1")), "sampling delays no record"
    finally:
        session.stop()
        thread.join(15)
    # Counted from the start: the first sample bears the time at which its values, perhaps late, were there.
    periods = (samples[-1].time_ns - started_ns) / NANOSECONDS_PER_SECOND / settings.metering_period_s
    assert len(samples) <= periods + 1, "a period that was missed is not made up for"


def test_a_value_that_is_refused_ends_no_visit(bench: Bench, relay: ScriptedRelay, metered: Relay) -> None:
    """Else the relay would be set aside for it after a few, and its records never pulled."""
    relay.unreadable = {f"{MMXU}.A": DataAccessError.HARDWARE_FAULT}
    samples: list[Sample] = []
    settings = bench.settings.model_copy(update={"metering_period_s": 0.05})
    session = RelaySession(metered, MOTOR, bench.repository, bench.store, settings, on_sample=samples.append)
    thread = Thread(target=session.run)
    thread.start()
    try:
        assert eventually(lambda: len(samples) >= 5)
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"))
    finally:
        session.stop()
        thread.join(15)
    assert bench.repository.link_figures(NAME).connections == 1
    assert not any("ia_A" in sample.values for sample in samples)


def test_how_long_a_sample_takes_is_told_by_the_latest_with_or_without_statistics(
    bench: Bench, metered: Relay
) -> None:
    metering = Metering(metered, MOTOR, period_s=0.1, on_sample=lambda _sample: None)
    assert metering.takes_s() == 0.0
    with Client.connect("127.0.0.1", metered.port) as client:
        began_s = time.monotonic()
        metering.sample(client)
        assert metering.takes_s() == 0.0, "that one had statistics, the next one has none"
        metering.sample(client)
    assert 0.0 < metering.takes_s() < time.monotonic() - began_s
