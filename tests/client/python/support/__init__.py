"""What the tests of the Python package have in common."""
