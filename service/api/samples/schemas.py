"""What the routes of a recording's samples answer."""

from typing import Annotated

from pydantic import Field

from core.signals.sequence import PhaseSequence
from service.api.document import Document, Listed
from service.waveforms.spectra import HIGHEST_ORDER

MOST_POINTS = 20_000


class Phasor(Document):
    """An rms phasor; its angle counts from `reference`, and a positive one leads."""

    name: str
    magnitude: float
    angle_deg: float
    unit: str


class Phasors(Document):
    """Phasors of the cycle around a time, and their symmetrical components.

    at_s: middle of the cycle, in seconds after the first sample. components: 1 is the system that turns as
    the supply does, 2 the one that turns against it, 0 what all phases have in common, where it was measured.
    frequency_is_assumed: none could be found, and the rated one was taken.
    """

    recording_id: str
    at_s: float
    frequency_hz: float
    frequency_is_assumed: bool
    sequence: PhaseSequence
    reference: str
    phases: Listed[Phasor]
    components: Listed[Phasor]
    voltage_unbalance: float | None
    current_unbalance: float | None
    active_power_W: float | None
    power_factor: float | None


class SpectralLine(Document):
    """A line to look for: where it lies, what makes it, and how strong it is in each phase (rms)."""

    label: str
    meaning: str
    frequency_hz: float
    amplitude_A: tuple[float, float, float]
    level_dB: float


Levels = Annotated[list[float], Field(max_length=MOST_POINTS)]


class Spectrum(Document):
    """The spectrum of the line currents under a Hann window, up to HIGHEST_ORDER times the supply's.

    Levels are beside the strongest line; those below -120 dB are -120. Of lines that are too many, the
    strongest of each interval is given. resolution_hz: nearer lines run into one. slip: from the speed that
    the diagnosis found; null without. seconds_for_sidebands: how long a recording has to be to tell the
    sidebands of broken bars from the supply's line.
    """

    recording_id: str
    first_s: float
    last_s: float
    supply_hz: float
    resolution_hz: float
    slip: float | None
    seconds_for_sidebands: float | None
    frequency_hz: Levels
    a_dB: Levels
    b_dB: Levels
    c_dB: Levels
    lines: Listed[SpectralLine]


Spectrum.__doc__ = (Spectrum.__doc__ or "").replace("HIGHEST_ORDER", f"{HIGHEST_ORDER:g}")


class StateTimeline(Document):
    """A state recorded beside the samples, by its changes; `is_cut` where it has more."""

    name: str
    begins_with: bool
    changes_s: Annotated[list[float], Field(max_length=2000)]
    is_cut: bool


class States(Document):
    """The states of a recording, in the file's order; times are seconds after the first sample."""

    recording_id: str
    duration_s: float
    states: Listed[StateTimeline]
