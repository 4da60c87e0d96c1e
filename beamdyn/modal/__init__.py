"""Reduced models: eigenproblems, modal bases, tracking, estimated errors, choice of the cheapest model."""
