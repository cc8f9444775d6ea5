"""Loaded tooth contact of a pair."""
