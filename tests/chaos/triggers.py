"""Requesting recordings: over REST until there is an answer, or at the relay as another client would."""

import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from http import HTTPStatus
from threading import Event, Lock, Timer

import httpx

from mms import Client, MmsError
from service.client.credentials import headers_for
from service.client.rest_client import API
from tests.chaos.history import History
from tests.chaos.plant import ChaosPlant
from tests.chaos.schedule import Action

ANSWER_LIMIT_S = 5.0
RETRY_AFTER_S = 0.5
HOLD_S = 0.05
ASKED_AT_ONCE = 8


@dataclass(frozen=True, slots=True)
class Asked:
    """A trigger the service accepted: the recording request it was answered with, after so many tries."""

    key: str
    relay: str
    motor: str
    request: str
    tries: int


class Triggers:
    """Sends what the schedule says. `ask` and `make` are called in threads of their own."""

    def __init__(self, plant: ChaosPlant, url: str, history: History) -> None:
        self._plant = plant
        self._http = httpx.Client(
            base_url=url,
            headers=headers_for(url),
            timeout=ANSWER_LIMIT_S,
            trust_env=False,
            limits=httpx.Limits(max_keepalive_connections=ASKED_AT_ONCE),
        )
        self._history = history
        self._lock = Lock()
        self.asked: dict[str, Asked] = {}
        self.made: Counter[str] = Counter()
        self.unanswered: set[str] = set()
        self.contradictions: list[str] = []
        self._give_up = Event()

    def ask(self, action: Action) -> None:
        """Until the service accepts, always with the same Idempotency-Key."""
        relay = self._plant.relay(action.relay)
        key = f"chaos-{action.number}"
        tries = 0
        with self._lock:
            self.unanswered.add(key)
        while not self._give_up.is_set():
            tries += 1
            request = self.post(relay.motor, key)
            if request is not None:
                with self._lock:
                    self.unanswered.discard(key)
                    self.asked[key] = Asked(key, relay.name, relay.motor, request, tries)
                return
            self._give_up.wait(RETRY_AFTER_S)

    def give_up_in(self, seconds: float) -> None:
        """Those still asking after this time stop; they are unanswered."""
        timer = Timer(seconds, self._give_up.set)
        timer.daemon = True
        timer.start()

    def post(self, motor: str, key: str) -> str | None:
        """Return the recording request's id; None where there was no answer, or one that means: try again."""
        try:
            answer = self._http.post(f"{API}/motors/{motor}/event-reports", headers={"Idempotency-Key": key})
        except httpx.TransportError:
            return None
        if answer.status_code == HTTPStatus.ACCEPTED:
            return str(answer.json()["id"])
        if answer.status_code < HTTPStatus.INTERNAL_SERVER_ERROR:
            self.contradictions.append(f"{key}: answered {answer.status_code} {answer.text[:200]}")
        return None

    def ask_again(self, most: int) -> None:
        """Keys that were answered before must give the same requests again."""
        asked = list(self.asked.values())[:most]
        with ThreadPoolExecutor(ASKED_AT_ONCE) as asking:
            answers = asking.map(lambda each: self.post(each.motor, each.key), asked)
            for each, request in zip(asked, answers, strict=True):
                if request != each.request:
                    self.contradictions.append(f"{each.key}: was {each.request}, asked again: {request}")

    def make(self, action: Action) -> None:
        """A record made at the relay, by a client that is not the service."""
        relay = self._plant.relay(action.relay)
        try:
            with Client.connect(relay.own.host, relay.own.port, request_timeout_s=ANSWER_LIMIT_S) as client:
                with self._lock:
                    self.made[relay.name] += 1
                for control in relay.triggers:
                    client.operate(control, True)  # noqa: FBT003 - the value of a control
                    time.sleep(HOLD_S)
                    client.operate(control, False)  # noqa: FBT003
        except MmsError as error:
            self._history.note(f"{relay.name}: no own trigger: {error}")

    def close(self) -> None:
        self._http.close()
