"""The files of recordings on disk."""
