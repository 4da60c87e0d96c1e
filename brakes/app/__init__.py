"""The interactive program ``brakes app``: documents (input files with their screens), screens and lists."""
