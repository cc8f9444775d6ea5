"""Errors of compiled functions."""


class NotStored(LookupError):
    """A function would have to be compiled where nothing may be."""
