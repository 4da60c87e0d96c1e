"""What all brakes share: their loads, self-locking, energy and heat of a stop, and inverse questions."""
