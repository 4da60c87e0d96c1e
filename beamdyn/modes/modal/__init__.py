"""Modal analysis: eigenproblems, modal bases, mode tracking, error estimates, choice of discretization."""
