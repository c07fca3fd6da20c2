"""Inputs that are wrong, one line each: what is called, what it raises, and words that the message must have."""
