"""Reading of scenes from TOML files with units, and of blades from other programs' files."""
