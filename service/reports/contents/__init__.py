"""What each kind of report says, from what the database has."""
