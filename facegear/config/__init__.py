"""The only place that validates a config and converts it to SI."""
