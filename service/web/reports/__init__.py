"""The page of reports, and the reports as files."""
