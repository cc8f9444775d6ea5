"""Rolling bearings: contacts of their elements, equilibrium and life."""
