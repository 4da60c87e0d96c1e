"""Work-precision diagrams: error against computing time, measured on a scene."""
