"""The files of recordings on disk, each set once, in a folder named by its content."""
