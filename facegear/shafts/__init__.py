"""Shafts on bearings, condensed statically to what a gear sits on, and chains of turning masses."""
