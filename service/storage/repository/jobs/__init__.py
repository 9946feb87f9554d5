"""Diagnoses to be made: their queue, and who works it off."""
