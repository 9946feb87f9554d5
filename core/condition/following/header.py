"""What a follower keeps of a motor in words and whole numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from core.condition.assessment import Change, Declared, Level
from core.condition.bus.differences import BusDifferences, Pair
from core.condition.changes.alarm import Alarm
from core.condition.changes.vanishing import Vanishing
from core.condition.following.standing import Called
from core.condition.following.standing_errors import StandingErrors
from core.condition.kinds import Kind
from core.condition.measuring.circle import BesideCircle
from core.condition.measuring.measurement import Measurement
from core.condition.observation import Observation, VoltageChannels


@dataclass(slots=True)
class Header:
    """Words and whole numbers of one direction of rotation.

    Parameters
    ----------
    recorder : str
        What measured the latest record.
    voltage_channels : VoltageChannels
        Which voltages it measured.
    as_of_ns, since_ns : int
        Time of the latest record, and of the first since the reference began, UTC [ns].
    scale_ohm : float
        Impedance z = |Z2n| at rated frequency as the motor's file said first [ohm]. Edited figures do not
        move it.
    accepted : bool
        Whether a person has declared the standing asymmetry healthy.
    declared : Declared or None
        Shorted turns that the records showed before that.
    alarm : Alarm or None
        The change that is seen.
    kept : Change or None
        An earlier change of the channels or the impedance that is in the standing errors.
    kept_errors : list of float
        E and C at the time of which it is told.
    gone : Change or None
        Shorted turns that have vanished, without anybody telling why.
    standing : StandingErrors or None
        The standing errors as they were when the change was detected.
    called : Called or None
        The standing fault that was called.
    held_score : float
        Score of the standing errors, held while it falls by little.
    bus : BusDifferences
        Differences from the bus's other motors.
    start : list of Measurement
        The first records of a reference, until there are eight.
    """

    recorder: str = ""
    voltage_channels: VoltageChannels = VoltageChannels.PHASE
    as_of_ns: int = 0
    since_ns: int = 0
    scale_ohm: float = 0.0
    accepted: bool = False
    declared: Declared | None = None
    alarm: Alarm | None = None
    kept: Change | None = None
    kept_errors: list[float] = field(default_factory=list)
    gone: Change | None = None
    standing: StandingErrors | None = None
    called: Called | None = None
    held_score: float = 0.0
    bus: BusDifferences = field(default_factory=BusDifferences)
    start: list[Measurement] = field(default_factory=list)

    def measured_by(self, observation: Observation) -> bool:
        """Return whether a record was measured by something else than the one before.

        Parameters
        ----------
        observation : Observation
            The record.

        Returns
        -------
        bool
            Whether the channels are others.
        """
        before = (self.recorder, self.voltage_channels)
        return before != (observation.recorder, observation.voltage_channels)

    def as_dict(self) -> dict[str, Any]:
        """Return the header as JSON holds it.

        Returns
        -------
        dict of str to object
            Words and numbers; floats keep all their digits.
        """
        return {
            "recorder": self.recorder,
            "voltage_channels": str(self.voltage_channels),
            "as_of_ns": self.as_of_ns,
            "since_ns": self.since_ns,
            "scale_ohm": self.scale_ohm,
            "accepted": self.accepted,
            "declared": None if self.declared is None else asdict(self.declared),
            "alarm": None if self.alarm is None else asdict(self.alarm),
            "kept": None if self.kept is None else asdict(self.kept),
            "kept_errors": self.kept_errors,
            "gone": None if self.gone is None else asdict(self.gone),
            "standing": None if self.standing is None else asdict(self.standing),
            "called": None if self.called is None else asdict(self.called),
            "held_score": self.held_score,
            "moved": [self.bus.moved.real, self.bus.moved.imag],
            "mean_moved": [self.bus.mean_moved.real, self.bus.mean_moved.imag, self.bus.records],
            "pairs": {n: [p.mean.real, p.mean.imag, p.records] for n, p in self.bus.pairs.items()},
            "start": [_as_list(record) for record in self.start],
        }

    @classmethod
    def from_dict(cls, words: Mapping[str, Any]) -> "Header":
        """Return the header that `as_dict` wrote.

        Parameters
        ----------
        words : mapping
            Words and numbers.

        Returns
        -------
        Header
            The header.
        """
        alarm = words["alarm"]
        if alarm is not None:
            alarm = Alarm(**alarm)
            alarm.named = tuple(Kind(kind) for kind in alarm.named)
            if alarm.vanishing is not None:
                vanishing = words["alarm"]["vanishing"]
                alarm.vanishing = Vanishing(**{**vanishing, "change": _change(vanishing["change"])})
            alarm.pending = tuple(Kind(kind) for kind in alarm.pending)
            alone = words["alarm"]["alone"]
            alarm.alone = None if alone is None else _change(alone)
        return cls(
            recorder=words["recorder"],
            voltage_channels=VoltageChannels(words["voltage_channels"]),
            as_of_ns=words["as_of_ns"],
            since_ns=words["since_ns"],
            scale_ohm=words["scale_ohm"],
            accepted=words["accepted"],
            declared=None if words["declared"] is None else _declared(words["declared"]),
            alarm=alarm,
            kept=None if words["kept"] is None else _change(words["kept"]),
            kept_errors=words["kept_errors"],
            gone=None if words["gone"] is None else _change(words["gone"]),
            standing=None if words["standing"] is None else StandingErrors(**words["standing"]),
            called=None if words["called"] is None else _called(words["called"]),
            held_score=words["held_score"],
            bus=BusDifferences(
                {n: Pair(complex(re, im), count) for n, (re, im, count) in words["pairs"].items()},
                complex(*words["moved"]),
                complex(*words["mean_moved"][:2]),
                words["mean_moved"][2],
            ),
            start=[_from_list(values) for values in words["start"]],
        )


def _declared(words: Mapping[str, Any]) -> Declared:
    low, high = words["ci95"]
    return Declared(words["level"], (low, high), words["phase"])


def _change(words: Mapping[str, Any]) -> Change:
    level = dict(words["level"])
    level["interval"] = _interval(level["interval"])
    level["phases"] = None if level["phases"] is None else tuple(level["phases"])
    return Change(
        since_ns=words["since_ns"],
        detected_ns=words["detected_ns"],
        probabilities={Kind(kind): share for kind, share in words["probabilities"].items()},
        named=tuple(Kind(kind) for kind in words["named"]),
        level=Level(**level),
        channel=words["channel"],
        size=words["size"],
        surely_above=words["surely_above"],
        size_ci95=_interval(words["size_ci95"]),
        until_ns=words["until_ns"],
    )


def _called(words: Mapping[str, Any]) -> Called:
    return Called(StandingErrors(**words["errors"]), words["score"], words["above"])


def _interval(ends: Sequence[float] | None) -> tuple[float, float] | None:
    return None if ends is None else (ends[0], ends[1])


def _as_list(record: Measurement) -> list[float | bool]:
    values: list[float | bool] = []
    for value in (*record[:-1], record.circle.distance, record.circle.outwards, *record.circle.slopes):
        values.extend((value.real, value.imag) if isinstance(value, complex) else (value,))
    return values


def _from_list(values: Sequence[float]) -> Measurement:
    elapsed_s, *parts = values
    y, j1, j2, v2, v0, i0, i2, bus = (complex(parts[2 * k], parts[2 * k + 1]) for k in range(8))
    scatter, has_v0, has_bus, distance, real, imaginary, *slopes = parts[16:]
    a, b, c, d, e, f = slopes
    circle = BesideCircle(distance, complex(real, imaginary), (a, b, c, d, e, f))
    return Measurement(
        elapsed_s, y, j1, j2, v2, v0, i0, i2, bus, scatter, bool(has_v0), bool(has_bus), circle
    )
