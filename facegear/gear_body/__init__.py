"""Gear bodies that bend: hub, web and rim as axisymmetric finite elements, order by order round the axis."""
