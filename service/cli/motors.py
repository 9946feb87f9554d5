"""`mcc motors`, `mcc health`: the condition of every motor, and all that is known of one."""

from collections.abc import Mapping, Sequence

from rich.box import SIMPLE_HEAD
from rich.console import RenderableType
from rich.text import Text

from core.condition.kinds import State
from core.error_words import one_line
from core.machines.parameters import ParametersSource
from core.machines.typical import COMMISSION
from core.motor_condition.parts import RANKS
from service.cli.output import facts_table, failing_clearly, print_document, results
from service.client.classification import answer_rows
from service.client.conditions import as_of, condition_lines, condition_of, since_day, state_text
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.rotor_conditions import rotor_lines, rotor_of
from service.client.tables import FittedTable
from service.client.verdicts import (
    detection,
    interval,
    level,
    load,
    local_time,
    local_times,
    percent,
    reasons_of,
    seen_in,
    verdict_text,
)

LINK_COLOURS = {"up": "green", "down": "red", "quarantined": "red"}
TYPICAL = str(ParametersSource.TYPICAL)
NO_RECORDING = "no recording yet"


def list_motors(url: str, *, as_json: bool) -> None:
    """Print one line for each motor of the plant: its condition, those that need attention first.

    Raises CommandError.
    """
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        motors = list(service.list_motors(health=True, limit=1000))
        healths = sorted((_listed_health(motor) for motor in motors), key=_need)
        table = motors_table(healths)
    if as_json:
        print_document({"motors": motors})
        return
    console = results()
    console.print(table)
    for line in (*_links_in_trouble(healths), *_offers(healths)):
        console.print(line, soft_wrap=True)


def show_health(url: str, motor: str, *, as_json: bool) -> None:
    """Print a motor's condition: what to do and why, its rotor, its latest recording. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        health = service.get_health(motor)
        answer = service.get_classification(motor)
        lines = condition_lines(condition_of(health))
        rotor = rotor_of(service, motor)
        told = [(name, Text(one_line(words))) for name, words in answer_rows(answer)]
    if as_json:
        print_document({**health, "rotor": rotor, "classification": answer})
        return
    parts = (lines, told, rotor_lines(rotor), _latest_recording(health))
    results().print(facts_table(*parts, title=motor))


def motors_table(healths: Sequence[Document]) -> FittedTable:
    """Return the table of `mcc motors`; 80 columns hold all of it. Raises ServiceError."""
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("motor", no_wrap=True)
    table.add_column("condition")
    table.add_column("level %", justify="right", no_wrap=True)
    table.add_column("since", no_wrap=True)
    table.add_column("as of")
    table.add_column("link", no_wrap=True)
    for health in healths:
        condition = condition_of(health)
        table.add_row(
            Text(str(health["motor"])),
            _state(health, condition),
            _level(condition),
            since_day(condition),
            as_of(condition),
            _link(health),
        )
    return table


def _need(health: Document) -> tuple[int, str]:
    """Return the key by which motors are sorted: the worst state first, then the name."""
    return RANKS[State(str(condition_of(health)["state"]))], str(health["motor"])


def _state(health: Document, condition: Document) -> Text:
    """Return the condition's state; of a motor of which nothing but the nameplate is known, what it needs."""
    state = state_text(condition)
    return state.append(f"; {COMMISSION}") if health.get("parameters_source") == TYPICAL else state


def _level(condition: Document) -> str:
    """Return the level in percent with its interval, without the signs: "0.62 [0.31..0.93]"."""
    if condition["mu_f"] is None:
        return "-"
    return f"{percent(condition['mu_f'])} [{interval(condition['mu_f_ci95'])}]"


def _links_in_trouble(healths: Sequence[Document]) -> list[Text]:
    """Return a line for each relay whose link has something to say, with its motors' names."""
    motors: dict[tuple[str, str, str], list[str]] = {}
    for health in healths:
        if health["link_reason"] is not None:
            link = (str(health["ied"]), str(health["link_state"]), local_times(health["link_reason"]))
            motors.setdefault(link, []).append(str(health["motor"]))
    return [
        Text(f"{relay} ({', '.join(names)}): {state}: {reason}", style=LINK_COLOURS.get(state, ""))
        for (relay, state, reason), names in motors.items()
    ]


def _offers(healths: Sequence[Document]) -> list[Text]:
    """Return a line for each motor with nothing but a nameplate whose start was recorded."""
    return [
        Text(local_times(f"{health['motor']}: {advice}"))
        for health in healths
        if health.get("parameters_source") == TYPICAL
        and isinstance(starts := health.get("starts"), Mapping)
        and (advice := starts["advice"]) is not None
    ]


def _listed_health(motor: Document) -> Document:
    health = motor.get("health")
    if not isinstance(health, Mapping):
        raise ServiceError("the list of motors has no health in it: is the service older than this command?")
    return health


def _latest_recording(health: Document) -> list[tuple[str, RenderableType]]:
    """Return the lines of what the latest recording says by itself, and of the relay."""
    last = _last_recording(health)
    rows: list[tuple[str, RenderableType]] = []
    if health["verdict"] is not None:
        rows.append(("latest verdict", verdict_text(str(health["verdict"]))))
        if health["mu_f"] is not None:
            rows.append(("equivalent fault level", level(health["mu_f"], health["mu_f_ci95"])))
            rows.append(("detection limit", detection(health["detection_limit"])))
        if health["phase"] is not None:
            rows.append(("phase", str(health["phase"])))
        if health["load_level"] is not None:
            rows.append(("load level", load(health["load_level"], health["load_level_ci95"])))
        rows.extend(("reason", Text(reason)) for reason in reasons_of(health))
        diagnosed = local_time(health["recorded_time"])
        if diagnosed != last:
            rows.append(("diagnosed recording", diagnosed))
    rows.append(("parameters", Text(str(health.get("parameters_source", "-")))))
    rows.append(("last recording", Text(NO_RECORDING if last is None else last)))
    if health.get("stood_time") is not None:
        rows.append(("last seen to stand", local_time(health["stood_time"])))
    rows.extend(_starts(health))
    rows.append(("site, relay", Text(f"{health['site']}, {health['ied']}")))
    rows.append(("link", _link_with_reason(health)))
    return rows


def _last_recording(health: Document) -> str | None:
    """Return when the last recording was made, and its state where it is not diagnosed."""
    last = health["last_recording"]
    if not isinstance(last, Mapping):
        return None
    when = local_time(last["recorded_time"] or last["announced_time"])
    if last["state"] == "diagnosed":
        return f"{when}{seen_in(last.get('operation'))}"
    reason = f": {one_line(str(last['reason']))}" if last["reason"] else ""
    return f"{when}, {last['state']}{reason}"


def _starts(health: Document) -> list[tuple[str, RenderableType]]:
    """Return the line of the starts that were recorded, and of what they are good for."""
    starts = health.get("starts")
    if not isinstance(starts, Mapping):
        return []
    if starts["advice"] is not None:
        return [("starts", Text(one_line(str(starts["advice"]))))]
    return [("starts", f"{starts['number']}, the latest {local_time(starts['latest_time'])}")]


def _link(health: Document) -> Text:
    state = str(health["link_state"])
    return Text(state, style=LINK_COLOURS.get(state, ""))


def _link_with_reason(health: Document) -> Text:
    link = _link(health)
    if health["link_reason"] is not None:
        link.append(f": {local_times(health['link_reason'])}")
    return link
