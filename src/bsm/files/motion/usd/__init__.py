"""USD, read and written with usd-core: points with time samples, their units and the axis that points up."""
