"""The page that shows streams in a browser; `web` has its sources and builds it."""
