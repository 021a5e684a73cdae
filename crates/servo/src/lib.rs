//! The haptic loop: paced or virtual time, device in and wrench out.
