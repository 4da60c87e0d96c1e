"""Linear models at one steady speed: their matrices, state space, and responses over frequency."""
