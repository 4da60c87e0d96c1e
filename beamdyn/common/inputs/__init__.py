"""Inputs described once, their checks, their combinations in designs, and parts of objects by path."""
