"""Scenes, mechanisms and reference solutions that benchmarks and tests share."""
