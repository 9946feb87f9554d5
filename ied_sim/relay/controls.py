"""Controls of a relay: set and cleared by clients, and pulses that fall by themselves."""

import threading
from collections.abc import Callable

from ied_sim.errors import SimulatorError
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.monitoring.relay_word import RelayWord
from ied_sim.relay.points import RelayPoints
from mms import AddCause, ControlAction


class RelayControls:
    """Present state of all controls of one relay. Several threads may use it.

    `publish` tells clients the state of controls at a time. `on_rise` is called with a control that has
    risen, and when. `pulse_s` gives the length of a pulse that begins at a time, `now_ns` the present time.

    Raises SimulatorError where the control that switches a misbehaviour is missing or has another meaning.
    """

    def __init__(
        self,
        relay_name: str,
        points: RelayPoints,
        word: RelayWord,
        misbehaviour_state: MisbehaviourState,
        *,
        publish: Callable[[dict[str, bool], int], None],
        on_rise: Callable[[str, int], None],
        pulse_s: Callable[[int], float],
        now_ns: Callable[[], int],
    ) -> None:
        self._points = points
        self._word = word
        self._misbehaviour_state = misbehaviour_state
        self._switches = _switches(relay_name, points, misbehaviour_state)
        self._publish = publish
        self._on_rise = on_rise
        self._pulse_s = pulse_s
        self._now_ns = now_ns
        # Held from a change until it is published: clients of both servers then see the same last state.
        self._lock = threading.Lock()
        self._bits = dict.fromkeys(points.controls, False)
        self._timers: list[threading.Timer] = []

    def publish_all(self, time_ns: int) -> None:
        """Publish the state of all controls."""
        with self._lock:
            self._publish(dict(self._bits), time_ns)

    def operate(self, action: ControlAction) -> bool | AddCause:
        """Set or clear a control, unless it is only a test; runs in a pump's thread."""
        switches = self._switches.get(action.reference)
        if self._misbehaviour_state.is_on(Kind.REFUSED_CONTROL) and switches is None:
            return AddCause.BLOCKED_BY_INTERLOCKING
        if action.test:
            return True
        now_ns = self._now_ns()
        value = bool(action.value)
        rises = self._set(action.reference, now_ns, value=value)
        if switches is not None:
            self._misbehaviour_state.switch(switches, on=value)
        if rises:
            self._on_rise(action.reference, now_ns)
            if action.reference in self._points.pulsed:
                self._fall_later(action.reference, self._pulse_s(now_ns))
        return True

    def stop(self) -> None:
        """Let no pulse fall any more."""
        with self._lock:
            timers, self._timers = self._timers, []
        for timer in timers:
            timer.cancel()
            timer.join()

    def _set(self, reference: str, time_ns: int, *, value: bool) -> bool:
        """Set a control and publish it; return True if it rises."""
        with self._lock:
            rises = value and not self._bits[reference]
            self._bits[reference] = value
            number = self._points.remote_bit(reference)
            if number is not None:
                together = (each for each in self._bits if self._points.remote_bit(each) == number)
                self._word.set(f"RB{number}", any(self._bits[each] for each in together), time_ns)
            self._publish({reference: value}, time_ns)
        return rises

    def _fall_later(self, reference: str, delay_s: float) -> None:
        timer = threading.Timer(delay_s, lambda: self._set(reference, self._now_ns(), value=False))
        timer.daemon = True
        with self._lock:
            self._timers = [each for each in self._timers if each.is_alive()]
            timer.start()
            self._timers.append(timer)


def _switches(relay_name: str, points: RelayPoints, misbehaviour_state: MisbehaviourState) -> dict[str, str]:
    """Return the controls that switch a misbehaviour, by their reference."""
    switches = {points.reference(each): each for each in misbehaviour_state.switches()}
    for unknown in sorted(switches.keys() - set(points.controls)):
        raise SimulatorError(f"{relay_name}: the misbehaviour's switch {unknown} is no control of this relay")
    own = points.triggers | {points.control(key) for key in ("start", "stop", "clear")}
    for meant in sorted(switches.keys() & own):
        raise SimulatorError(
            f"{relay_name}: the misbehaviour's switch {meant} has a meaning of its own (points of its "
            "profile): choose a free control"
        )
    return switches
