"""Transient simulation: motion of the beam in time, with step sizes, integrators, errors, and sweeps."""
