"""The interactive program of beamdyn: screens for frequencies, responses and other analyses of a beam."""
