//! Haptic devices: capabilities, workspace map, scripted motion.
