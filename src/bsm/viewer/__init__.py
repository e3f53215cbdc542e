"""The page that shows streams in a browser; `tools/web` has its sources and builds it."""
