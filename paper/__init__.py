"""Reproduction of one publication: its claims, the scorecard, the search for its undisclosed inputs."""
