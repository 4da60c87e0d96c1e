"""What all brakes share: what they are loaded by, what locks, and the energy of a stop."""
