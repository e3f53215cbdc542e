"""The commands of `bsm`: one module each, with add_arguments and run."""
