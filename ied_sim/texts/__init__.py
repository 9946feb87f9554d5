"""Text reports of the relay, made at each request from its journal."""

from ied_sim.texts.making import FOLDER, SETTINGS_FOLDER, Maker, texts
from ied_sim.texts.story import Story

__all__ = ["FOLDER", "SETTINGS_FOLDER", "Maker", "Story", "texts"]
