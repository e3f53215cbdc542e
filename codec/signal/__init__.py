"""From positions to quantized coefficients and back."""
