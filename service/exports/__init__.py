"""What plants take elsewhere: trends, recordings, starts, measurements, alarms as CSV, Excel and Parquet."""
