"""Ranges of answers over tolerances of inputs, for both packages, each of which evaluates its own answers."""

DEFAULT_SAMPLES = 1024
