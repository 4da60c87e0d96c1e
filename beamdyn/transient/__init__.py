"""Motion in time: step size, integrators, one run, and sweeps over speeds."""
