"""Base of all brakes: loads, self-locking, energy and heat of a stop, and inverse questions."""
