"""What an export costs: time and memory of long tables in every format."""
