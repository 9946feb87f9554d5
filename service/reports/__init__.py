"""Reports of the fleet, of a motor and of the alarms of a time, as PDF and as Excel workbooks."""
