"""The interactive program of beamdyn: screens on frequencies, responses and other analyses of a beam."""
