"""How frequencies, critical speeds and resonance speeds change with the numbers of a scene."""
