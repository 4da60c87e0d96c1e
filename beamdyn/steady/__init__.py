"""Motion that repeats: excitation by rotation and road, harmonic balance, steady response, resonances."""
