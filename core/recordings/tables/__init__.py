"""Tables of samples: what loggers, oscilloscopes and programs for signals write beside COMTRADE."""
