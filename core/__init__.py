"""The numbers: recordings, machine models, optimisers, diagnosis. Knows no network, no database, no clock."""
