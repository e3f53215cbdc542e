"""What a release consists of, made from the last commit and tried as users would: `python -m tools.release`."""
