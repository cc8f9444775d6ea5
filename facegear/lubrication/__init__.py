"""Sliding, friction, loss, heat and lubricant film of the loaded contact."""
