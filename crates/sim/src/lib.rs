//! One haptic tick as a pure function: tool, world, coupling, contact.
