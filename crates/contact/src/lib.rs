//! Contact of a rigid haptic tool with convex objects.

mod paper;
