"""The text files that a relay offers, and which report is in each."""

from collections.abc import Callable, Iterable, Mapping
from typing import Final

from ied_sim.profiles.profile import Text
from ied_sim.texts import history, load_profile, motor_reports, sequence
from ied_sim.texts.snapshot import RelaySnapshot

FOLDER: Final = "REPORTS"
SETTINGS_FOLDER: Final = "SETTINGS"

TextMaker = Callable[[RelaySnapshot], bytes]

MAKERS: Final[Mapping[Text, TextMaker]] = {
    "HISTORY": history.history,
    "CHISTORY": history.compressed_history,
    "SER": sequence.sequence,
    "CSER": sequence.compressed_sequence,
    "LDP": load_profile.load_profile,
    "CLDP": load_profile.compressed_load_profile,
    "MSR": motor_reports.motor_starts,
    "MOT": motor_reports.motor_statistics,
}


def settings_text(snapshot: RelaySnapshot) -> bytes:
    """Make SET_ALL.TXT: the settings by name."""
    return snapshot.report("SETTINGS", [f'{name},"{value}"' for name, value in snapshot.settings])


def texts(offered: Iterable[Text], *, settings: bool) -> dict[str, TextMaker]:
    """Return the makers of the text files that a relay offers, by path under its root."""
    made = {f"{FOLDER}/{name}.TXT": MAKERS[name] for name in offered}
    if settings:
        made[f"{SETTINGS_FOLDER}/SET_ALL.TXT"] = settings_text
    return made
