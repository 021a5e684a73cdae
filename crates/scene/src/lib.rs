//! Scene files: RON in, world and device choice out, errors with line and column.
