"""Reports as files: of the fleet, of a motor, of the alarms of a month."""
