//! Haptic rendering through flexible tools.
fn main() {}
