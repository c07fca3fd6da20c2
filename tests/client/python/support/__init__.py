"""The common parts of the tests of the Python package."""
