"""What to do about a motor's condition, in words for who plans the work."""

from collections.abc import Iterable
from dataclasses import dataclass

from core.condition.kinds import Kind, State
from core.machines.typical import COMMISSION

HEALTHY = ("Nothing needs to be done.",)
UNKNOWN = (
    "Have the motor recorded while it runs: there is no usable record yet, or none since the latest event.",
    "If records exist, look why they were refused: wrong channels, a wrong ratio, or no steady running.",
)
COMMISSION_ME = (
    f"{COMMISSION}. Give the motor its own parameters: mcc commission from a recorded start, or mcc "
    "parameters from its data sheet."
)
COMMISSION_AGAIN = (
    "Commission this motor (mcc commission), or check its nameplate, parameters and ratios: {} of its file "
    "do not fit its records."
)
FAULT_URGENCY = (
    "Stop the motor at the next opportunity, within days: shorted turns run hot and take others with them."
)
FAULT_OR_JOINT_URGENCY = (
    "Stop the motor at the next opportunity, within days: either runs hot and gets worse by itself."
)


@dataclass(frozen=True, slots=True)
class _Task:
    """What a kind of change asks for.

    Parameters
    ----------
    check : str
        What to check first; {where} stands for "in phase b" or the like.
    urgency : str
        How urgent it is while the motor is on watch.
    surer : str
        What would make it surer.
    """

    check: str
    urgency: str
    surer: str


_TASKS = {
    Kind.NONE: _Task(
        "Check the winding{where} by a surge test and by the resistance of its phases.",
        "It can wait for the next planned stop.",
        "Further records tell whether it stays.",
    ),
    Kind.SHORTED_TURNS: _Task(
        "Check the winding{where}: surge test, resistance of the phases, insulation to earth.",
        "The level is not surely above the motor's limit: plan the check for the next stop and record the "
        "motor more often until then.",
        "Further records narrow the interval of the level.",
    ),
    Kind.VOLTAGE_CHANNEL: _Task(
        "Check the voltage transformer{where}: secondary terminals, fuses, burden, and the relay's input.",
        "The motor itself need not stop, but until it is mended a fault{where} may hide behind it.",
        "Compare with the other motors of the bus: on common transformers they all see it, and the "
        "voltages of a healthy channel agree.",
    ),
    Kind.CURRENT_CHANNEL: _Task(
        "Check the current transformer{where}: secondary terminals, shorting links, burden, and the relay's "
        "input.",
        "Check soon, because the relay protects the motor by the same current.",
        "A clamp meter on the secondary beside the relay's reading tells.",
    ),
    Kind.CONNECTION: _Task(
        "Check the joints{where}, from the contactor to the terminal box, by a thermal image under load and "
        "by the voltage drop of each phase.",
        "Check within days: a joint that heats gets worse by itself.",
        "A record at another load tells, because the drop over a joint grows with the current.",
    ),
    Kind.SUPPLY: _Task(
        "Check the supply of the bus: tap changers, capacitor banks, single-phase loads, fuses.",
        "The motor itself need not stop; above 2 % of unbalance run it at less than its rated load.",
        "The other motors of the bus see it too.",
    ),
    Kind.PARAMETERS: _Task(
        "Check whether the motor, its rotor or its winding was exchanged, or its file edited.",
        "Not urgent, but until it is told, changes are seen less well.",
        "Enter what was done as an event of the motor; if it was exchanged, commission it again.",
    ),
    Kind.ROTOR: _Task(
        "Check the rotor's bars: look at the sidebands in a record of several seconds near rated load.",
        "Plan it within weeks, and avoid repeated starts until then.",
        "A longer record at a higher load tells.",
    ),
    Kind.ASYMMETRY: _Task(
        "Check the winding by a surge test and by the resistance of its phases, and the transformers' "
        "secondaries.",
        "It can wait for the next planned stop: what is known of faults does not explain it.",
        "A record at another load tells more.",
    ),
    Kind.OTHER_LOAD: _Task(
        "Check what hangs on the motor's feeder between the relay's transformers and the motor: elements and "
        "fuses of capacitors, heaters, another motor.",
        "The motor itself need not stop.",
        "If something was connected there or taken away, enter that as an event of the motor: `maintenance`.",
    ),
    Kind.UNCLEAR: _Task(
        "Look first whether somebody worked at the motor, its relay or its supply, and enter that as an "
        "event.",
        "Not urgent yet: what has changed is not told.",
        "Have the motor recorded a few times more, at another load if possible.",
    ),
}

_UNCONFIRMED = _Task(
    "Have the motor recorded again: the latest record differs from all before, and one alone proves nothing.",
    "Do so today.",
    "If the next record agrees with those before, nothing needs to be done.",
)

_GONE = _Task(
    "Ask whether the winding or a joint was repaired, and enter that as a note: `rewound` for the winding, "
    "`maintenance` for a joint. If nobody worked there, check the joints and the winding{where}: shorted "
    "turns do not heal, but a contact that comes and goes can look so.",
    "Check within days if nobody repaired it.",
    "If it comes back, the next records show it.",
)

_BY_PAIR = {
    frozenset((Kind.SHORTED_TURNS, Kind.CONNECTION)): _Task(
        "Check the joints from the contactor to the terminal box first (thermal image, voltage drop of each "
        "phase), then the winding{where} (surge test, resistance of the phases).",
        "Check within days: either gets worse by itself.",
        "A record at another load tells: the drop over a joint grows with the current, that of shorted turns "
        "does not.",
    ),
    frozenset((Kind.SHORTED_TURNS, Kind.ASYMMETRY)): _Task(
        "Check the winding{where}: surge test, resistance of the phases, insulation to earth.",
        "Plan it for the next stop, and record the motor more often until then.",
        "A record at another load tells: shorted turns change the forward-turning current too, another "
        "asymmetry hardly.",
    ),
    frozenset((Kind.SHORTED_TURNS, Kind.OTHER_LOAD)): _Task(
        "Check capacitors and heaters on the motor's feeder first (a clamp meter in each line, the motor at "
        "rest), then the winding{where}: surge test, resistance of the phases.",
        "Plan it for the next stop, and record the motor more often until then.",
        "A record at another load tells: what hangs beside the motor draws the same current at any load.",
    ),
    frozenset((Kind.CONNECTION, Kind.ASYMMETRY)): _Task(
        "Check the joints{where} from the contactor to the terminal box first (thermal image, voltage drop "
        "of each phase), then the winding (surge test, resistance of the phases).",
        "Check within days: a joint that heats gets worse by itself.",
        "A record at another load tells: the drop over a joint grows with the current, that of another "
        "asymmetry does not.",
    ),
    frozenset((Kind.VOLTAGE_CHANNEL, Kind.ASYMMETRY)): _Task(
        "Check the voltage transformer's secondary{where} and fuses first, then the winding (surge test, "
        "resistance of the phases).",
        "It can wait for the next planned stop; record the motor more often until then.",
        "Compare with the other motors of the bus: an asymmetry of the motor is seen in its currents alone, "
        "a voltage channel in the voltages.",
    ),
    frozenset((Kind.CURRENT_CHANNEL, Kind.ASYMMETRY)): _Task(
        "Check the current transformer's secondary{where} first, by a clamp meter beside the relay's "
        "reading, then the winding (surge test, resistance of the phases).",
        "Check soon, because the relay protects the motor by the same current.",
        "A record at another load tells: the error of a channel grows with the current, that of another "
        "asymmetry does not.",
    ),
    frozenset((Kind.SHORTED_TURNS, Kind.VOLTAGE_CHANNEL)): _Task(
        "Check the voltage transformer's secondary and fuses first, then the winding{where} (surge test, "
        "resistance of the phases).",
        "Plan it for the next stop, and record the motor more often until then.",
        "Compare with the other motors of the bus: a fault is seen by this motor alone in its currents, a "
        "voltage channel in its voltages.",
    ),
    frozenset((Kind.SHORTED_TURNS, Kind.CURRENT_CHANNEL)): _Task(
        "Check the current transformer's secondary first, then the winding{where} (surge test, resistance of "
        "the phases).",
        "Plan it for the next stop, and record the motor more often until then.",
        "A record at another load tells: the error of a channel grows with the current, that of shorted "
        "turns does not.",
    ),
}


def advice(
    state: State,
    kind: Kind,
    *,
    phase: str | None = None,
    candidates: Iterable[Kind] = (),
    is_gone: bool = False,
    is_typical: bool = False,
    misfits: Iterable[str] = (),
) -> str:
    """Say what to check first, how urgent it is, and what would make it surer.

    Parameters
    ----------
    state : State
        State of the motor.
    kind : Kind
        What has changed.
    phase : str or None, optional
        Phase that it is seen in.
    candidates : iterable of Kind, optional
        What it may be, likeliest first, where the kind is unclear; none where a single record differs.
    is_gone : bool, optional
        Whether it has vanished.
    is_typical : bool, optional
        Whether nothing but the motor's nameplate is known.
    misfits : iterable of str, optional
        Parameters of the motor's file that the records contradict.

    Returns
    -------
    str
        Two or three sentences; one for a healthy motor.
    """
    if is_typical:
        if state is State.UNKNOWN:
            return COMMISSION_ME
        told = advice(state, kind, phase=phase, candidates=candidates, is_gone=is_gone)
        return f"{told} {COMMISSION_ME}"
    wrong = tuple(misfits)
    if wrong:
        told = (
            ""
            if state is State.HEALTHY
            else advice(state, kind, phase=phase, candidates=candidates, is_gone=is_gone)
        )
        return f"{told} {COMMISSION_AGAIN.format(', '.join(wrong))}".strip()
    if state is State.HEALTHY:
        return " ".join(HEALTHY)
    if state is State.UNKNOWN:
        return " ".join(UNKNOWN)
    task = _TASKS[kind]
    if kind is Kind.UNCLEAR:
        likeliest = frozenset(tuple(candidates)[:2])
        task = _BY_PAIR.get(likeliest, task) if likeliest else _UNCONFIRMED
    if is_gone:
        task = _GONE
    urgency = task.urgency
    if state is State.FAULT:
        urgency = FAULT_OR_JOINT_URGENCY if kind is Kind.UNCLEAR else FAULT_URGENCY
    where = "" if phase is None else f" of phase {phase}"
    return " ".join((task.check, urgency, task.surer)).replace("{where}", where)
