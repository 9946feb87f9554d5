"""`mcc audit`: who changed what, taken elsewhere, and whether it is as it was written."""
