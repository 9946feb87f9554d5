"""One run: plant, proxy and service up, the schedule done, everything healed, the evidence taken."""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from subprocess import CalledProcessError

from service.client.rest_client import ServiceClient
from service.demo.addresses import free_ports
from testing.tcp_proxy import Proxy
from testing.waiting import eventually
from tests.chaos import account
from tests.chaos.database import Database, serving_database
from tests.chaos.disk import Disk, SmallDisk, WritingLimit
from tests.chaos.evidence import Evidence, growth
from tests.chaos.faults import Faults
from tests.chaos.hang_watch import HangWatch
from tests.chaos.history import History
from tests.chaos.ledger import Ledger
from tests.chaos.order import Order
from tests.chaos.plant import ChaosPlant, make_plant
from tests.chaos.result import Result, result_of
from tests.chaos.schedule import OWN_TRIGGER, TRIGGER, Action, make_schedule
from tests.chaos.served import ServedService, handles_of, running
from tests.chaos.settling import links_not_up, settle
from tests.chaos.simulators import running_simulators, stop_all
from tests.chaos.triggers import Triggers

LINKS_UP_LIMIT_S = 300.0
REST_LIMIT_S = 20.0
"""Until threads and connections of the last requests are gone."""

HANDS = 64
"""Threads that carry actions out; a trigger waits in one until the service accepts it."""

SETTINGS = {
    "MCC_POLL_PERIOD_S": "1",
    "MCC_LEASE_S": "10",
    "MCC_CONNECT_TIMEOUT_S": "2",
    "MCC_REQUEST_TIMEOUT_S": "3",
    "MCC_RECORD_TIMEOUT_S": "15",
    "MCC_JOB_ATTEMPTS": "20",
    "MCC_MAX_OPEN_REQUESTS": "10000",
    "MCC_MAX_QUEUED_DIAGNOSES": "10000",
    "MCC_JOB_RETRY_DELAY_S": "0.2",
}
"""Shorter times than usual, for more rounds in the same time; and as many attempts as there may be."""

DISK_BYTES, DISK_BYTES_A_RECORD = 48 * 1024**2, 60_000
MOST_ASKED_AGAIN = 200
TRIGGERS_LIMIT_S = 120.0
"""How long after the last action a trigger may take to be accepted."""

Tell = Callable[[str], None]


def run(order: Order, directory: Path, tell: Tell) -> Result:
    """Run, and judge. `directory` keeps logs and, but for what is on the small disk, data.

    Raises RuntimeError, OSError where the plant or the service do not even come up.
    """
    history = History()
    plant = make_plant(directory, order.relays)
    schedule = make_schedule(
        plant,
        seed=order.seed,
        length_s=order.schedule_s,
        recordings=order.recordings,
        faults=order.faults,
        database=order.database,
    )
    (directory / "schedule.txt").write_text("".join(f"{action}\n" for action in schedule), encoding="utf-8")
    tell(f"{len(schedule)} actions in {order.schedule_s:.0f} s, listed in {directory / 'schedule.txt'}")
    try:
        with serving_database(order.database, directory / "data", history) as database:
            service = _service(plant, directory, database, history)
            disk = _disk(service, order.recordings)
            tell(f"disk: {disk.description}")
            evidence = _evidence(plant, schedule, service, database, disk, directory, history, tell)
    finally:
        (directory / "history.txt").write_text("\n".join(history.lines()) + "\n", encoding="utf-8")
    profiles = dict(Counter(relay.profile.name for relay in plant.relays))
    return result_of(order, profiles, disk.description, evidence)


def _service(plant: ChaosPlant, directory: Path, database: Database, history: History) -> ServedService:
    """Two gateways, so that relays change hands."""
    own = {
        "MCC_SCD": str(plant.service_scd),
        "MCC_MOTORS": str(plant.motors),
        "MCC_RELAYS_PER_GATEWAY": str(-(-len(plant.relays) // 2)),
    }
    (port,) = free_ports(1)
    settings = SETTINGS | own | database.settings
    return ServedService(directory / "data", directory / "service.log", settings, port, history)


def _disk(service: ServedService, recordings: int) -> Disk:
    try:
        return SmallDisk(service.data, DISK_BYTES + DISK_BYTES_A_RECORD * recordings)
    except (CalledProcessError, OSError):
        return WritingLimit(service.all_processes)


def _evidence(
    plant: ChaosPlant,
    schedule: Sequence[Action],
    service: ServedService,
    database: Database,
    disk: Disk,
    directory: Path,
    history: History,
    tell: Tell,
) -> Evidence:
    began_s = time.monotonic()
    files = directory / "relays"
    with ExitStack() as stack:
        simulators = stack.enter_context(running_simulators(plant, directory, files))
        watch = stack.enter_context(HangWatch(simulators, history.note))
        proxy = stack.enter_context(Proxy({each.name: (each.own, each.seen) for each in plant.relays}))
        stack.enter_context(running(service))
        client = stack.enter_context(ServiceClient(service.url))
        triggers = Triggers(plant, service.url, history)
        stack.callback(triggers.close)
        ledger = stack.enter_context(Ledger(plant, files))
        if not eventually(lambda: not links_not_up(client, plant), LINKS_UP_LIMIT_S):
            raise RuntimeError(f"links are not up: {links_not_up(client, plant)}; see {service.log}")
        account.ask_at_once(client)  # so that the service has opened what it opens for many requests
        at_first = _handles(service)
        faults = Faults(plant, files, service, simulators, proxy, database, disk, history)
        tell(f"everything is up after {time.monotonic() - began_s:.0f} s")
        history.begin()
        noticed = _carry_out(schedule, faults, triggers, tell)
        healed_s = time.monotonic()
        tell("the schedule is done, settling")
        open_matters = settle(client, plant, ledger, triggers, tell)
        settled_s = time.monotonic()
        triggers.ask_again(MOST_ASKED_AGAIN)
        rows, requests = account.rows(client), account.requests(client)
        told = account.files_of_all(client, [row.id for row in rows if row.is_fetched])
        eventually(lambda: not growth(at_first, _handles(service)), REST_LIMIT_S)
        at_last = _handles(service)
        exit_code = service.stop()
        watch.stop()
        stop_all(simulators)
        tell("the service and the relays have ended, comparing")
        recordings = service.data / "recordings"
        return Evidence(
            schedule=schedule,
            history=history,
            ledger=ledger,
            triggers=triggers,
            truth=ledger.records(),
            rows=rows,
            requests=requests,
            told=told,
            store=account.folders(recordings),
            left_arriving=account.left_arriving(recordings),
            at_first=at_first,
            at_last=at_last,
            exit_code=exit_code,
            integrity=database.integrity(),
            diagnosed_twice=database.diagnosed_twice(),
            noticed=[*noticed, *service.unwanted_ends, *(hang for each in simulators for hang in each.hangs)],
            open_matters=open_matters,
            pulled_bytes=proxy.carried_bytes,
            settled_after_s=settled_s - healed_s,
            lasted_s=time.monotonic() - began_s,
        )


def _carry_out(schedule: Sequence[Action], faults: Faults, triggers: Triggers, tell: Tell) -> list[str]:
    """Every action at its time, each in a thread. Returns which could not be done as meant."""
    begin_s = time.monotonic()
    running_actions: list[tuple[Action, Future[None]]] = []
    with ThreadPoolExecutor(HANDS, "hand") as hands, ThreadPoolExecutor(HANDS, "fault") as fault_hands:
        for number, action in enumerate(schedule):
            time.sleep(max(0.0, begin_s + action.at_s - time.monotonic()))
            if action.kind == TRIGGER:
                future = hands.submit(triggers.ask, action)
            elif action.kind == OWN_TRIGGER:
                future = hands.submit(triggers.make, action)
            else:
                future = fault_hands.submit(faults.do, action)
            running_actions.append((action, future))
            if number % 100 == 0:
                tell(f"{action.at_s:.0f} s: {number} of {len(schedule)} actions")
        triggers.give_up_in(TRIGGERS_LIMIT_S)
    failed = ((action, future.exception()) for action, future in running_actions)
    return [f"{action} could not be done: {error!r}" for action, error in failed if error is not None]


def _handles(service: ServedService) -> dict[str, tuple[int, int]]:
    main = service.process_id
    return {
        "service": handles_of([] if main is None else [main]),
        "gateways": handles_of(service.gateways()),
        "workers": handles_of(service.workers()),
    }
