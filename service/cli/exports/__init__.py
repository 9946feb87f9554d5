"""`mcc export`: files of what the service keeps, for spreadsheets and programs."""
