"""Constants of encoder and denoiser halved and doubled: what each does to the figure that it serves."""
