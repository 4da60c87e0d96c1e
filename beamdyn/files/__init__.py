"""Reading of scenes from TOML files with units, and of blades from files of other programs."""
