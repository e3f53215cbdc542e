"""Ways of coding coefficients, one file each."""
