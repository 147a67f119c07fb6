"""Materials of other programs, with constant parameters fitted to a model; formulas on NumPy arrays."""
