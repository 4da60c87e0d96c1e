"""Loads, strains and stresses along the span: at rest and at speed, in a transient, in steady response."""
