"""Natural modes at steady speed, critical speeds, equilibria, and guaranteed bounds of frequencies."""
