//! What must hold of every beam: symmetry, definiteness, rigid motions, equilibrium, agreement of all methods, and of large with small
//! deflections as loads vanish; on random beams of all sections, tapers, divisions and rest shapes.

mod beams;
mod compliance;
mod far;
mod linear;
mod matrix;
