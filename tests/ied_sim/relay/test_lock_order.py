"""The locks of mms and ied_sim: all are in the documented order, and every way through a relay keeps it."""

import ast
import io
import queue
import re
from collections.abc import Iterator
from pathlib import Path

from ied_sim.misbehaviour import Kind, Misbehaviour
from mms import Report
from testing.lock_order import LockOrder, recorded_lock_order
from testing.relays.simulated import IED, Simulated, names, scenario_of, simulated
from testing.waiting import wait_until
from tests.ied_sim.relay.test_two_doors import both_doors

REPOSITORY = Path(__file__).parents[3]
PAGE = REPOSITORY / "docs" / "explanation" / "architecture.md"
REPORTS = f"{IED}CFG/LLN0.BR.BRep01"


def documented() -> list[str]:
    """Names of the locks, in the order in which they may be taken."""
    section = PAGE.read_text(encoding="utf-8").partition("\n## Locks\n")[2].partition("\n## ")[0]
    return re.findall(r"^\| `([\w.]+)` \|", section, re.MULTILINE)


def locks_of(package: str) -> Iterator[str]:
    """Names of the locks that a package makes, as LockOrder names them."""
    for path in sorted((REPOSITORY / package).rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for owner in [tree, *(node for node in ast.walk(tree) if isinstance(node, ast.ClassDef))]:
            inside = owner.body if isinstance(owner, ast.Module) else list(ast.walk(owner))
            for node in inside:
                if isinstance(node, ast.Assign | ast.AnnAssign) and _makes_lock(node.value):
                    target = node.targets[0] if isinstance(node, ast.Assign) else node.target
                    attribute = target.attr if isinstance(target, ast.Attribute) else ast.unparse(target)
                    yield f"{owner.name}.{attribute}" if isinstance(owner, ast.ClassDef) else attribute


def _makes_lock(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Call) and ast.unparse(value.func).endswith(
        ("Lock", "Condition", "Semaphore")
    )


def test_every_lock_has_its_place_in_the_documented_order() -> None:
    made = [*locks_of("mms"), *locks_of("ied_sim")]
    assert len(made) > 10
    assert sorted(made) == sorted(documented())


def test_a_relay_with_two_servers_takes_its_locks_in_the_documented_order(tmp_path: Path) -> None:
    restart = Misbehaviour(Kind.RESTART, switch="CON/RBGGIO1.SPCSO30", for_s=0.2)
    with (
        recorded_lock_order(["mms", "ied_sim"]) as order,
        simulated(tmp_path, scenario_of("sel-710-ed2", restart)) as served,
    ):
        for _ in range(2):
            _use_everything(served)
            served.relay._relay_server.go_down()
            served.relay._relay_server.come_up()
    assert order.circle() == []
    places = {name: place for place, name in enumerate(documented())}
    assert [pair for pair in sorted(order.pairs) if places[pair[0]] >= places[pair[1]]] == []
    assert {("Server._lock", "RelayControls._lock"), ("RelayControls._lock", "RelayServer._publishing")} <= (
        order.pairs
    )


def _use_everything(served: Simulated) -> None:
    """Operate, record, trip, report, list and read at both servers."""
    numbers = served.relay._archive.last_number
    for client in both_doors(served):
        client.subscribe(REPORTS, queue.SimpleQueue[Report]())
        for control in ("RBGGIO1.SPCSO03", "PRBGGIO1.SPCSO01", "RBGGIO1.SPCSO04"):
            client.operate(served.reference(f"CON/{control}"), value=True)
            client.operate(served.reference(f"CON/{control}"), value=False)
        client.download("REPORTS/HISTORY.TXT", io.BytesIO())
        wait_until(lambda: served.relay._archive.last_number != numbers, "a record")
        assert names(client, "EVENTS")
        client.close()
    with served.relay._acting:
        served.relay._trip(["thermal"], 0)


def test_locks_taken_in_a_circle_are_found() -> None:
    """As the servers of a relay once were: each server's thread updated the other server."""
    order = LockOrder()
    order.pairs = {("a", "b"), ("b", "c"), ("Server._lock", "Server._lock")}
    assert order.circle() == ["Server._lock", "Server._lock"]
    order.pairs = {("a", "b"), ("b", "c"), ("c", "a"), ("a", "d")}
    assert order.circle() == ["a", "b", "c", "a"]
