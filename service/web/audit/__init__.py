"""The audit trail on a page: who changed what, and whether all of it is as it was written."""
