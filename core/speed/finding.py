"""What a record tells of the motor's speed."""

from dataclasses import asdict, dataclass
from enum import StrEnum


class SpeedState(StrEnum):
    """Whether the lines of the rotor tell the speed."""

    SEEN = "seen"
    ALTERNATIVES = "alternatives"
    """Lines are seen, but several numbers of bars explain them, each with another speed."""
    NOT_SEEN = "not-seen"


class SpeedSource(StrEnum):
    """Where a speed comes from."""

    CURRENT = "current"
    """Seen in the current: lines of the rotor, without parameters of the motor."""
    MODEL = "model"
    """By the model: the slip at which its circuit makes the torque that crosses the air gap."""

    @property
    def words(self) -> str:
        """The source in words."""
        return "seen in the current" if self is SpeedSource.CURRENT else "by the model"


@dataclass(frozen=True, slots=True)
class SpeedAlternative:
    """The speed if the rotor has so many bars.

    Parameters
    ----------
    rotor_bars : int
        Number of bars.
    speed_rpm : float
        Speed of the shaft [rpm].
    speed_rpm_ci95 : tuple of float
        Its 95 % interval, if the number is right [rpm].
    """

    rotor_bars: int
    speed_rpm: float
    speed_rpm_ci95: tuple[float, float]


@dataclass(frozen=True, slots=True)
class SpeedFinding:
    """The speed of the shaft in one record.

    Parameters
    ----------
    state : SpeedState
        Whether the current shows it.
    source : SpeedSource or None
        Where the speed comes from; None where there is none.
    speed_rpm : float or None
        The speed: that seen in the current, otherwise that of the model [rpm].
    speed_rpm_ci95 : tuple of float or None
        Its 95 % interval; None of the model's [rpm].
    slip : float or None
        The slip at this speed.
    model_speed_rpm : float or None
        Speed by the model, to compare [rpm].
    rotor_bars : int or None
        Number of bars with which the speed is seen.
    margin : float or None
        By how much the speed beats every separate one, the least of all pieces in which it is seen [nats].
    alternatives : tuple of SpeedAlternative
        Speeds by number of bars, the likeliest first, where the records do not tell them apart.
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: SpeedState
    source: SpeedSource | None
    speed_rpm: float | None
    speed_rpm_ci95: tuple[float, float] | None
    slip: float | None
    model_speed_rpm: float | None
    rotor_bars: int | None
    margin: float | None
    alternatives: tuple[SpeedAlternative, ...]
    reasons: tuple[str, ...]

    @property
    def seen_slip(self) -> float | None:
        """The slip that is seen in the current; None where none is."""
        return self.slip if self.state is SpeedState.SEEN else None

    def as_dict(self) -> dict[str, object]:
        """Return the part `speed` of the document that `mcc diagnose --json` prints.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        interval = self.speed_rpm_ci95
        return asdict(self) | {
            "state": str(self.state),
            "source": None if self.source is None else str(self.source),
            "speed_rpm_ci95": None if interval is None else list(interval),
            "alternatives": [
                asdict(one) | {"speed_rpm_ci95": list(one.speed_rpm_ci95)} for one in self.alternatives
            ],
            "reasons": list(self.reasons),
        }
