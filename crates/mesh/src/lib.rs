//! Validated triangle, half-edge and convex meshes with loaders and generators.
