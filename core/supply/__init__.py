"""The supply of a motor: frequency, unbalance, harmonics and power, by the definitions of NEMA and IEC."""
