"""What records tell of broken rotor bars: found, missed and falsely alarmed, on simulated motors."""
