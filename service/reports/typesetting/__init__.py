"""Reports as PDF: typst sets them in a process of its own, which ends with its memory."""
