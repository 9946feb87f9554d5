"""The audit trail in the database: entries written with the change they tell of, and read again."""
