"""Steady motion: excitation by rotation and road, harmonic balance, response, resonances and stability."""
