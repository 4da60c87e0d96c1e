"""Input files of brakes: TOML text with units is read into core objects; all mistakes are in one message."""
