"""What plants take elsewhere: trends, recordings, measurements, alarms as CSV, Excel and Parquet."""
