"""The same work on one input or on many: what is written where, who does it, and the record of what came of it."""
