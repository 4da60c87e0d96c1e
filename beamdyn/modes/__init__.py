"""Natural modes at steady speed, the speeds at which they vanish, and guaranteed bounds."""
