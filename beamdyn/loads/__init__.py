"""Loads, strains and stresses along the span: static, in a transient, in steady and random response."""
