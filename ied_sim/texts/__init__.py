"""Text reports of the relay, made at each request from its journal."""

from ied_sim.texts.catalogue import FOLDER, SETTINGS_FOLDER, Maker, texts
from ied_sim.texts.snapshot import Story

__all__ = ["FOLDER", "SETTINGS_FOLDER", "Maker", "Story", "texts"]
