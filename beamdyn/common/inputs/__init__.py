"""Inputs that are described once, their checks, their combinations in designs, and parts by path."""
