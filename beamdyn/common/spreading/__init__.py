"""Ranges of answers over tolerances of inputs: what both packages share; each brings its evaluation."""

DEFAULT_SAMPLES = 1024
