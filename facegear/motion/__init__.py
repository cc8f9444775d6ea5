"""Time response of the lumped model: integration, steady state, stability, speed sweeps, branches."""
