"""Version number of the packages beamdyn and brakes, which are released together."""

__version__ = "0.1.0"
