"""What the encoder chooses: promises and targets, the ways to keep them, and the cheapest of these."""
