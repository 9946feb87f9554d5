"""Parameters followed over records: drifts found, missed and falsely told, and whether intervals hold."""
