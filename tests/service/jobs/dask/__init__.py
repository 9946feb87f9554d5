"""Workers of a Dask cluster, and schedulers that mean harm."""
