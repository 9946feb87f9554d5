"""What the simulation of one candidate costs, beside scipy and motulator."""
