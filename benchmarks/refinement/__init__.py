"""Our two least-squares loops beside scipy's, on the same residuals and derivatives."""
