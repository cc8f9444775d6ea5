"""The stages as pure functions: slices of a config and earlier results in, an Outcome out.

One module a stage, so that the fingerprint of a stage holds exactly the code that it can reach.
"""
