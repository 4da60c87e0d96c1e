"""Motion in time: step size, integrators, one run, batches of runs, and sweeps over speeds."""
