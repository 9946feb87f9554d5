"""The audit trail for those who may read it: pages, all of it as it was hashed, and whether it is intact."""
