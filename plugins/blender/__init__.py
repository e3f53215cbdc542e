"""The extension for Blender: its sources in `extension`, and what makes an installable zip of them."""
