"""The tables of figures that the README shows, measured again."""
