"""Transients: motion in time, with step sizes, integrators, errors, and sweeps over speeds."""
