"""The interactive program ``brakes app``: documents, screens and lists for all types of brakes."""
