"""A scene as equations of motion: discretizations, their operators, and the list of terms."""
