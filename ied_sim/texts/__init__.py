"""Text reports of the relay, made at each request from its journal."""

from ied_sim.texts.catalogue import FOLDER, SETTINGS_FOLDER, TextMaker, texts
from ied_sim.texts.snapshot import RelaySnapshot

__all__ = ["FOLDER", "SETTINGS_FOLDER", "RelaySnapshot", "TextMaker", "texts"]
