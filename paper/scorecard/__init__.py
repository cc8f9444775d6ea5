"""The paper's claims held against computed results, one row each."""
