"""The stages as pure functions: slices of a config and earlier results in, an Outcome out."""
