"""Ranges of answers of a scene over tolerances of its inputs."""
