"""The choices of the encoder: the cheapest way to keep promises and targets."""
