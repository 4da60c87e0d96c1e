"""How frequencies, critical speeds and crossings change with the numbers of a scene."""
