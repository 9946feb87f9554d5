"""Recordings: asked for, stored, kept and deleted; the folders of their files, and baselines of them."""
