"""What plants do to motors and measurements: how records and histories of it are judged."""
