"""What a diagnosis of one record costs."""
