"""Elastic parts of a machine: gear bodies, the layer of their teeth, shafts."""
